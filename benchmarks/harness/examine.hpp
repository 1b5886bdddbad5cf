#pragma once

// One configuration of one energy, held against what it should be: the figures and verdicts of
// docs/protocol.md, section 1. The checked pass, replay and the tests all judge by this.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "benchmarks/harness/figures.hpp"
#include "benchmarks/harness/symmetries.hpp"
#include "kernels/kernel.hpp"
#include "reference/oracle.hpp"

namespace definite {

enum class Verdict {
  kPass,
  kDegraded,
  kNonPsd,
  kNonFinite,
  kSilentZero,
  kInconsistent,
  kOutOfDomain,
  kCrash,  // of a fuzzed case; a sweep has none
};
inline constexpr int kVerdictCount = 8;
inline constexpr std::array<std::string_view, kVerdictCount> kVerdictNames = {
    "pass",        "degraded",     "non_psd",       "non_finite",
    "silent_zero", "inconsistent", "out_of_domain", "crash"};

// What to look at besides distance, excess, finite, PSD yes or no, which cost microseconds.
struct Depth {
  bool definition;  // the filter's definition in double; where in doubt, in float128
  bool spectrum;    // eigenvalues, majorisation, translations, symmetries
  bool truth;       // everything in float128: milliseconds

  static const Depth kCheap, kDefinition, kSpectral, kTruth;  // each includes those before it
  friend bool operator==(const Depth&, const Depth&) = default;
};
inline constexpr Depth Depth::kCheap = {false, false, false};
inline constexpr Depth Depth::kDefinition = {true, false, false};
inline constexpr Depth Depth::kSpectral = {true, true, false};
inline constexpr Depth Depth::kTruth = {true, true, true};

// What one row made of one configuration. Empty where the depth did not ask for it.
struct RowFigures {
  std::optional<double> distance, excess;
  std::optional<double> psd_defect, majorises, relabelling;
  std::optional<double> rounding, conditioned_rounding;
  std::optional<bool> flip;
  bool defined = false;  // held against its definition
  Verdict verdict = Verdict::kPass;
  // Promised properties that this configuration shows to be broken.
  std::vector<Property> broken;
};

// What holds for a configuration whatever the filter.
struct ConfigurationFigures {
  bool in_domain = false, active = false, indefinite = false;
  double conditioning = 1;  // sin of the edge angle, or as the protocol says for other families
  std::optional<double> value_rounding, gradient_rounding;  // conditioned, in units of n u
};

// H and P in double, and what every row asks of them.
struct ExactOutput {
  Packed h, nearest;
  Measures of_h;
  double nearest_norm;
};

// What a row made of a configuration.
struct RowOutput {
  Packed f;
  Measures measures;
  // The first row of the same filter that made the same bits; the row itself if there is none.
  std::size_t twin;
  bool asked = true;  // or not looked at, at this configuration
};

// Judges rows of one energy. Not thread safe; one for each thread.
class Examiner {
 public:
  // The energy must have a reference, and rows that give H and P in double; throws
  // std::runtime_error otherwise. Rows may be any of the energy's, in any order.
  Examiner(const EnergyRow& energy, std::span<const KernelRow* const> rows);

  // Judges configuration (x, p) by what rows made of it: outputs[r] row r, `exact` ExactRow and
  // NearestRow.
  void Examine(const double* x, const double* p, const ExactOutput& exact,
               std::span<const RowOutput> outputs, Depth depth);

  // The same, by matrices.
  void Examine(const double* x, const double* p, Packed h, Packed nearest,
               std::span<const Packed> outputs, Depth depth);

  // The same, running the rows first.
  void Examine(const double* x, const double* p, Depth depth);

  // none/f64.
  const KernelRow& ExactRow() const { return *exact_; }
  // nearest/f64x8, which takes a hundredth of the time; or numeric/f64 where there is none, or
  // where it is to be judged itself.
  const KernelRow& NearestRow() const { return *nearest_; }
  const ConfigurationFigures& Configuration() const { return configuration_; }
  const RowFigures& Row(std::size_t r) const { return figures_[r]; }

 private:
  struct Definitions;

  void ExamineRow(std::size_t r, const double* x, const double* p, const ExactOutput& exact,
                  const RowOutput& output, Depth depth, Definitions& definitions);
  void ExamineSpectrum(std::size_t r, const ExactOutput& exact, const RowOutput& output,
                       Definitions& definitions);
  void ExamineSymmetries(std::size_t r, const double* x, const double* p, const ExactOutput& exact,
                         const RowOutput& output, Definitions& definitions);
  void ExamineTruth(std::size_t r, Packed f, Definitions& definitions);
  // Whether the row of lanes has other bits than the scalar one, if that is among the rows.
  bool DiffersFromScalar(std::size_t r, std::span<const RowOutput> outputs) const;
  // Whether the digits of the input leave room for f beside the row's definition.
  bool IsOpen(std::size_t r, Packed f, Definitions& definitions) const;
  // Of another configuration: whether it is in the domain, its bound, and how far its digits leave a
  // definition open.
  bool InDomainAt(std::span<const double> x, std::span<const double> p) const;
  double BoundAt(const double* x, const double* p) const;
  double OpenAt(const reference::Filter<reference::Quad>& filter, const double* x,
                const double* p) const;
  void ExamineEnergy(const double* x, const double* p, Definitions& definitions);
  double Bound() const;  // of an error relative to |F|, by the conditioning
  double Conditioning(const double* x, const double* p) const;

  const EnergyRow* energy_;
  std::vector<const KernelRow*> rows_;
  const KernelRow* exact_;
  const KernelRow* nearest_;
  const reference::Energy<double>* reference_;
  const reference::Energy<reference::Quad>* quad_reference_;
  const reference::Filter<reference::Quad>* exact_filter_;
  std::vector<Symmetry> symmetries_;
  std::vector<const reference::Filter<double>*> filters_;
  std::vector<const reference::Filter<reference::Quad>*> quad_filters_;
  ConfigurationFigures configuration_;
  std::vector<RowFigures> figures_;
};

}  // namespace definite
