#pragma once

// What the filters promise, for people.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "kernels/kernel.hpp"

namespace definite {

inline constexpr std::array<Property, 10> kProperties = {
    Property::kFinite,   Property::kPsd,        Property::kAccurate,    Property::kLanesEqualScalar,
    Property::kKeepsPsd, Property::kMajorises,  Property::kRigidMotion, Property::kTranslation,
    Property::kScale,    Property::kRelabelling};

// "finite", "psd", ...: as JSON and tables have it.
std::string_view PropertyName(Property property);
std::optional<Property> PropertyNamed(std::string_view name);

// The properties with their meaning, then each filter with what it is exempt from and why:
// kernels/PROMISES.txt.
std::string PromiseTable();

}  // namespace definite
