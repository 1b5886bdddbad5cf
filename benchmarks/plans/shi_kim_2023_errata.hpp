#pragma once

// The misprints of Shi & Kim 2023, each as a formula in two forms that can be measured: as printed,
// and as it holds. `definite verify --errata`, docs/errata.md and the tests all measure these.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace definite {

enum class Form { kPrinted, kCorrected };

struct Misprint {
  std::string_view equation;            // "Eq. 31"
  std::string_view printed, corrected;  // the formula, in plain text
  std::string_view figure;              // what the error of a pair is
  std::string_view remark;              // why, and what it does
  std::span<const std::string_view> stencils;
  // Of one form at one pair, in float128; nothing where the equation says nothing of the pair.
  std::optional<double> (*error)(Form form, std::string_view stencil, const double* x);
};

struct ShiKim2023Errata {
  // Pairs of this distribution, with k = 1, eps = 1, m = 0.8.
  static constexpr std::string_view kDistribution = "normal";
  static constexpr std::uint64_t kSeed = 2023;
  static constexpr int kPairs = 1000;  // of each stencil

  static std::span<const Misprint> All();
  static const Misprint& Of(std::string_view equation);

  // The measured sizes of all, as Markdown that is readable as it stands: docs/errata.md.
  static std::string Markdown();
};

// Over the pairs of ShiKim2023Errata that the equation applies to.
struct MisprintSize {
  std::uint64_t pairs = 0, wrong = 0;  // wrong: by more than any rounding
  double median = 0, largest = 0;      // errors of the printed form where it is wrong
  double corrected = 0;                // the largest error of the corrected form
};
MisprintSize Measure(const Misprint& misprint);

}  // namespace definite
