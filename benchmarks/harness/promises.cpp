#include "benchmarks/harness/promises.hpp"

#include <fmt/format.h>

#include <map>

namespace definite {

namespace {

struct Words {
  std::string_view name, meaning;
};

Words WordsOf(Property property) {
  switch (property) {
    case Property::kFinite:
      return {"finite", "no NaN or infinity in the domain"};
    case Property::kPsd:
      return {"psd", "-lambda_min(F) / (n u |F|) at most 50"};
    case Property::kAccurate:
      return {"accurate", "conditioned rounding against its definition in float128 at most 50"};
    case Property::kLanesEqualScalar:
      return {"lanes_equal_scalar", "f64x8 equals f64 bit for bit"};
    case Property::kKeepsPsd:
      return {"keeps_psd", "F = H where H is PSD already"};
    case Property::kMajorises:
      return {"majorises", "F - H is PSD"};
    case Property::kRigidMotion:
      return {"rigid_motion", "F(R x + t) = R F(x) R^T"};
    case Property::kTranslation:
      return {"translation", "translations lie in the null space"};
    case Property::kScale:
      return {"scale", "lengths in another unit give the same F"};
    case Property::kRelabelling:
      return {"relabelling", "the numbering of the vertices does not matter"};
  }
  return {"unknown", ""};
}

}  // namespace

std::string_view PropertyName(Property property) { return WordsOf(property).name; }

std::optional<Property> PropertyNamed(std::string_view name) {
  for (Property property : kProperties) {
    if (PropertyName(property) == name) return property;
  }
  return std::nullopt;
}

std::string PromiseTable() {
  std::string table = "Every filter promises these properties:\n";
  for (Property property : kProperties) {
    const Words words = WordsOf(property);
    table += fmt::format("  {:<19} {}\n", words.name, words.meaning);
  }
  table += "except where it is listed here, with the reason.\n";
  std::map<std::string_view, std::span<const Exemption>> filters;
  for (const KernelRow& row : AllKernels()) filters[row.filter] = row.exempt;
  for (const auto& [filter, exempt] : filters) {
    table += fmt::format("\n{}\n", filter);
    if (exempt.empty()) table += "  promises all\n";
    for (const Exemption& e : exempt) {
      table += fmt::format("  {:<19} {}\n", PropertyName(e.property), e.why);
    }
  }
  return table;
}

}  // namespace definite
