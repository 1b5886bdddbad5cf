#pragma once

// Turns an energy and the filters into rows of the two tables. CMake reads the lines
// DEFINITE_ENERGY(...) and DEFINITE_FILTER(...) of energies/ and filters/ and writes one source
// file for each energy, so that a new energy or filter is one file and nothing else.

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/core/counting.hpp"
#include "kernels/kernel.hpp"
#include "kernels/outputs.hpp"
#include "kernels/run.hpp"

// The lines that CMake reads. An energy is held against its concept where its rows are made, in a
// file of its own: here it would be compiled for every energy anew.
#define DEFINITE_ENERGY(...) static_assert(sizeof(__VA_ARGS__) > 0)
#define DEFINITE_FILTER(...) \
  static_assert(std::convertible_to<decltype(__VA_ARGS__::kName), std::string_view>)

namespace definite {

// One energy's part of the tables.
struct EnergyTable {
  EnergyRow energy;
  std::vector<KernelRow> kernels, outputs;  // their energy is set where the tables are joined
};

// One for each energy; CMake writes it.
std::vector<EnergyTable> EnergyTables();

// What one configuration costs.
template <class E, class F, class Output>
Operations CountOperations(const double* x, const double* p) {
  struct Nowhere {
    void Store(int, const Counting&) const { ++Counting::done.stores; }
    Counting Load(int) const { return Counting(0.0); }
  };
  Vec<Counting, E::kDofs> xs;
  Vec<Counting, E::kParams> ps;
  for (int i = 0; i < E::kDofs; ++i) xs[i] = Counting(x[i]);
  for (int i = 0; i < E::kParams; ++i) ps[i] = Counting(p[i]);
  Counting::done = {};
  WriteOutput<E, F, Output>(xs, ps, Nowhere());
  return Counting::done;
}

// The modes that modes_of(x, p) gives, as numbers.
template <class E, class ModesOf>
ModeTable MakeModeTable(ModesOf) {
  using ModesType = std::remove_cvref_t<decltype(Stacked(
      ModesOf()(Vec<double, E::kDofs>(), Vec<double, E::kParams>())))>;
  constexpr int kCount = ModesType::kCount, kSize = sizeof(ModesType::v) / kCount / sizeof(double);
  return {kCount, kSize, [](const double* x, const double* p, double* out, long tiles) {
            ForTiles<E, ScalarTile, kCount*(1 + kSize)>(
                x, p, out, tiles, [](const auto& xs, const auto& ps, const auto& tile) {
                  const ModesType modes = Stacked(ModesOf()(xs, ps));
                  for (int m = 0; m < kCount; ++m) {
                    tile.Store(m * (1 + kSize), modes.lambda[m]);
                    for (int i = 0; i < kSize; ++i)
                      tile.Store(m * (1 + kSize) + 1 + i, modes.v[m][i]);
                  }
                });
          }};
}

template <class E, std::size_t kTerm>
FrameTable MakeFrameTable() {
  const auto modes_of = [](const auto& x, const auto& p) {
    return std::get<kTerm>(E::FrameTerms(x, p)).modes;
  };
  return {MakeModeTable<E>(modes_of),
          [](const double* x, const double* p, double* out, long tiles) {
            using Term =
                std::tuple_element_t<kTerm, decltype(E::FrameTerms(Vec<double, E::kDofs>(),
                                                                   Vec<double, E::kParams>()))>;
            constexpr int kD = E::kDofs, kNumbers = sizeof(Term::map) / sizeof(double);
            ForTiles<E, ScalarTile, kNumbers>(
                x, p, out, tiles, [](const auto& xs, const auto& ps, const auto& tile) {
                  const Term term = std::get<kTerm>(E::FrameTerms(xs, ps));
                  for (int k = 0; k < kNumbers; ++k) tile.Store(k, term.map[k / kD][k % kD]);
                });
          }};
}

template <class E>
EnergyRow MakeEnergy() {
  using Stencil = typename E::Stencil;
  EnergyRow row;
  row.name = E::Name();
  row.source = E::Source();
  row.stencil = Stencil::kName;
  row.dofs = E::kDofs;
  row.parameters = E::kParameters;
  row.relabellings = Stencil::kRelabellings;
  if constexpr (requires { E::kMirror; }) row.mirror = E::kMirror;
  row.tree = Stencil::kTree;
  row.dimension = Stencil::kDimension;
  row.value = [](const double* x, const double* p, double* out, long tiles) {
    ForTiles<E, ScalarTile, 1>(
        x, p, out, tiles,
        [](const auto& xs, const auto& ps, const auto& tile) { tile.Store(0, E::Value(xs, ps)); });
  };
  row.gradient = [](const double* x, const double* p, double* out, long tiles) {
    ForTiles<E, ScalarTile, E::kDofs>(x, p, out, tiles,
                                      [](const auto& xs, const auto& ps, const auto& tile) {
                                        const Vec<double, E::kDofs> g = E::Gradient(xs, ps);
                                        for (int i = 0; i < E::kDofs; ++i) tile.Store(i, g[i]);
                                      });
  };
  row.classify = [](const double* x, const double* p, double* out, long tiles) {
    ForTiles<E, ScalarTile, 3>(x, p, out, tiles,
                               [](const auto& xs, const auto& ps, const auto& tile) {
                                 const Classification<double> c = E::Classify(xs, ps);
                                 tile.Store(0, c.active);
                                 tile.Store(1, c.in_domain);
                                 tile.Store(2, c.region);
                               });
  };
  if constexpr (OffersSet<E, double, Set::kSplit>) {
    row.split = MakeModeTable<E>([](const auto& x, const auto& p) {
      return E::template HessianModes<Set::kSplit, Part::kAll>(x, p);
    });
  }
  if constexpr (WithFrame<E, double>) {
    using Terms = decltype(E::FrameTerms(Vec<double, E::kDofs>(), Vec<double, E::kParams>()));
    [&row]<std::size_t... kTerms>(std::index_sequence<kTerms...>) {
      row.frame = {MakeFrameTable<E, kTerms>()...};
    }
    (std::make_index_sequence<std::tuple_size_v<Terms>>());
  }
  return row;
}

template <class E, class F, class Tile, class Output>
KernelRow MakeKernel() {
  KernelRow row;
  row.name = E::Name();
  // What is not packed has its name at the end.
  for (std::string_view part : {F::kName, Tile::kScalar, Output::kName}) {
    if (part != PackedOutput<E>::kName) row.name.append(1, '/').append(part);
  }
  row.energy = nullptr;
  row.filter = F::kName;
  row.source = F::kSource;
  row.scalar = Tile::kScalar;
  row.output = Output::kName;
  row.exempt = F::kExempt;
  row.lanes = Tile::kLanes;
  row.outputs = Output::kNumbers;
  row.run = RunFilter<E, F, Tile, Output>;
  if constexpr (kStaged<E> && Tile::kLanes > 1) row.count = CountOperations<E, F, Output>;
  return row;
}

template <class E, class F, class Tile, class Output>
void AppendOutput(std::vector<KernelRow>& rows) {
  using T = typename Tile::Value;
  using H = decltype(F::template Apply<E>(Vec<T, E::kDofs>(), Vec<T, E::kParams>()));
  if constexpr (
      requires(Vec<T, E::kDofs> x, Vec<T, E::kParams> p, OutputTile<Tile> tile) {
        Output::template WriteOf<F>(x, p, tile);
      } ||
      requires(const H& h, OutputTile<Tile> tile) { Output::Write(h, tile); }) {
    rows.push_back(MakeKernel<E, F, Tile, Output>());
  }
}

template <class E, class F, class Tile>
void AppendKernel(EnergyTable& table) {
  // A filter that does not fit the energy or the scalar has no row; the catalogue test would
  // notice one that vanished.
  if constexpr (FilterOver<F, E, typename Tile::Value>) {
    table.kernels.push_back(MakeKernel<E, F, Tile, PackedOutput<E>>());
    // The outputs of the filter's fastest scalar.
    if constexpr (kStudied<E> && kHasOutputs<F> &&
                  (Tile::kLanes > 1 || !FilterOver<F, E, LanesTile::Value>)) {
      AppendOutput<E, F, Tile, DenseOutput<E>>(table.outputs);
      AppendOutput<E, F, Tile, AppliedOutput<E>>(table.outputs);
      AppendOutput<E, F, Tile, BlockSumOutput<E>>(table.outputs);
    }
    if constexpr (Tile::kLanes > 1 && (kStaged<E> && kHasStages<F>)) {
      AppendOutput<E, F, Tile, FrameOutput<E>>(table.outputs);
      AppendOutput<E, F, Tile, FramedOutput<E>>(table.outputs);
    }
  }
}

// A list of filter types; CMake writes the one of all filters.
template <class... F>
struct Filters {};

template <class E, class... F>
EnergyTable MakeTable(Filters<F...>) {
  static_assert(EnergyOver<E, double>);
  static_assert(EnergyOver<E, Lanes<double, kNativeLanes>>);
  EnergyTable table{MakeEnergy<E>(), {}, {}};
  (AppendKernel<E, F, ScalarTile>(table), ...);
  (AppendKernel<E, F, LanesTile>(table), ...);
  return table;
}

}  // namespace definite
