#pragma once

#include <span>
#include <string_view>

#include "reference/energy.hpp"
#include "reference/filter.hpp"
#include "reference/quad.hpp"
#include "reference/truth.hpp"

namespace definite::reference {

// Every energy of energies/ and every filter of filters/, for T = double and T = Quad, in the order
// of their files. Defined in oracle.cpp, which CMake writes from oracle.cpp.in.
template <class T>
std::span<const Energy<T>> AllEnergies();
template <class T>
std::span<const Filter<T>> AllFilters();

template <>
std::span<const Energy<double>> AllEnergies();
template <>
std::span<const Energy<Quad>> AllEnergies();
template <>
std::span<const Filter<double>> AllFilters();
template <>
std::span<const Filter<Quad>> AllFilters();

template <class Row>
const Row* FindByName(std::span<const Row> rows, std::string_view name) {
  for (const Row& row : rows)
    if (row.name == name) return &row;
  return nullptr;
}

// The energy or filter of that name, or nullptr.
template <class T>
const Energy<T>* FindEnergy(std::string_view name) {
  return FindByName(AllEnergies<T>(), name);
}
template <class T>
const Filter<T>* FindFilter(std::string_view name) {
  return FindByName(AllFilters<T>(), name);
}

}  // namespace definite::reference
