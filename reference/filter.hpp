#pragma once

#include <concepts>
#include <string_view>

#include "reference/truth.hpp"

namespace definite::reference {

// One filter, by name: its definition as a function of the truth. The result is dofs x dofs and
// symmetric.
template <class T>
struct Filter {
  std::string_view name;
  Matrix<T> (*define)(Truth<T>& truth);
};

// What a filter must define, for any scalar T.
template <class F>
concept FilterDefinition = requires(Truth<double>& truth) {
  { F::kName } -> std::convertible_to<std::string_view>;
  { F::Define(truth) } -> std::same_as<Matrix<double>>;
};

// The line by which CMake finds a filter: on one line, in namespace definite::reference.
#define DEFINITE_REFERENCE_FILTER(...) \
  static_assert(::definite::reference::FilterDefinition<__VA_ARGS__>)

// The table row of a filter.
template <class T, FilterDefinition F>
constexpr Filter<T> MakeFilter() {
  return {F::kName, [](Truth<T>& truth) { return F::Define(truth); }};
}

}  // namespace definite::reference
