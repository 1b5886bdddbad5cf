#pragma once

// Turns an energy and the filters into rows of the two tables. CMake reads the lines
// DEFINITE_ENERGY(...) and DEFINITE_FILTER(...) of energies/ and filters/ and writes one source
// file for each energy, so that a new energy or filter is one file and nothing else.

#include <string>
#include <string_view>
#include <vector>

#include "kernels/kernel.hpp"

// The lines that CMake reads. An energy is held against its concept where its rows are made, in a
// file of its own: here it would be compiled for every energy anew.
#define DEFINITE_ENERGY(...) static_assert(sizeof(__VA_ARGS__) > 0)
#define DEFINITE_FILTER(...) \
  static_assert(std::convertible_to<decltype(__VA_ARGS__::kName), std::string_view>)

namespace definite {

// One energy's part of the tables.
struct EnergyTable {
  EnergyRow energy;
  std::vector<KernelRow> kernels;  // their energy is set where the tables are joined
};

// One for each energy; CMake writes it.
std::vector<EnergyTable> EnergyTables();

// How a scalar type meets a tile: one configuration, or eight side by side. Eight is the storage,
// whatever the machine's vectors hold: `Value` may need several passes over a tile.
struct ScalarTile {
  static constexpr std::string_view kScalar = "f64";
  static constexpr int kLanes = 1, kPass = 1;
  using Value = double;
  static DEFINITE_INLINE double Load(const double* from) { return *from; }
  static DEFINITE_INLINE void Store(double value, double* to) { *to = value; }
};
struct LanesTile {
  static constexpr std::string_view kScalar = "f64x8";
  static constexpr int kLanes = 8, kPass = kNativeLanes;
  using Value = Lanes<double, kPass>;
  static DEFINITE_INLINE Value Load(const double* from) { return Value::Load(from); }
  static DEFINITE_INLINE void Store(const Value& value, double* to) { value.Store(to); }
};

// Runs `compute(x, p, store)` over the tiles; store(i, value) writes number i of `kOutputs`.
template <class E, class Tile, int kOutputs, class Compute>
DEFINITE_INLINE void ForTiles(const double* x, const double* p, double* out, long tiles,
                              Compute compute) {
  using T = typename Tile::Value;
  constexpr int kW = Tile::kLanes;
  for (long t = 0; t < tiles; ++t) {
    for (int w = 0; w < kW; w += Tile::kPass) {
      Vec<T, E::kDofs> xs;
      Vec<T, E::kParams> ps;
#pragma GCC unroll 16
      for (int i = 0; i < E::kDofs; ++i) xs[i] = Tile::Load(x + (t * E::kDofs + i) * kW + w);
#pragma GCC unroll 16
      for (int i = 0; i < E::kParams; ++i) ps[i] = Tile::Load(p + (t * E::kParams + i) * kW + w);
      double* tile = out + t * kOutputs * kW + w;
      compute(
          xs, ps, [tile](int i, const T& value) __attribute__((always_inline)) {
            Tile::Store(value, tile + i * kW);
          });
    }
  }
}

template <class E, class F, class Tile>
void RunFilter(const double* x, const double* p, double* out, long tiles) {
  constexpr int kSize = PackedSym<typename Tile::Value, E::kDofs>::kSize;
  ForTiles<E, Tile, kSize>(
      x, p, out, tiles,
      [](const auto& xs, const auto& ps, auto store)
          __attribute__((always_inline)) { ForPacked(F::template Apply<E>(xs, ps), store); });
}

// The modes that modes_of(x, p) gives, as numbers.
template <class E, class ModesOf>
ModeTable MakeModeTable(ModesOf) {
  using ModesType = decltype(ModesOf()(Vec<double, E::kDofs>(), Vec<double, E::kParams>()));
  constexpr int kCount = ModesType::kCount, kSize = sizeof(ModesType::v) / kCount / sizeof(double);
  return {kCount, kSize, [](const double* x, const double* p, double* out, long tiles) {
            ForTiles<E, ScalarTile, kCount*(1 + kSize)>(
                x, p, out, tiles, [](const auto& xs, const auto& ps, auto store) {
                  const ModesType modes = ModesOf()(xs, ps);
                  for (int m = 0; m < kCount; ++m) {
                    store(m * (1 + kSize), modes.lambda[m]);
                    for (int i = 0; i < kSize; ++i) store(m * (1 + kSize) + 1 + i, modes.v[m][i]);
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
                x, p, out, tiles, [](const auto& xs, const auto& ps, auto store) {
                  const Term term = std::get<kTerm>(E::FrameTerms(xs, ps));
                  for (int k = 0; k < kNumbers; ++k) store(k, term.map[k / kD][k % kD]);
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
  row.dimension = Stencil::kDimension;
  row.value = [](const double* x, const double* p, double* out, long tiles) {
    ForTiles<E, ScalarTile, 1>(x, p, out, tiles, [](const auto& xs, const auto& ps, auto store) {
      store(0, E::Value(xs, ps));
    });
  };
  row.gradient = [](const double* x, const double* p, double* out, long tiles) {
    ForTiles<E, ScalarTile, E::kDofs>(x, p, out, tiles,
                                      [](const auto& xs, const auto& ps, auto store) {
                                        const Vec<double, E::kDofs> g = E::Gradient(xs, ps);
                                        for (int i = 0; i < E::kDofs; ++i) store(i, g[i]);
                                      });
  };
  row.classify = [](const double* x, const double* p, double* out, long tiles) {
    ForTiles<E, ScalarTile, 3>(x, p, out, tiles, [](const auto& xs, const auto& ps, auto store) {
      const Classification<double> c = E::Classify(xs, ps);
      store(0, c.active);
      store(1, c.in_domain);
      store(2, c.region);
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

template <class E, class F, class Tile>
void AppendKernel(std::vector<KernelRow>& rows) {
  // A filter that does not fit the energy or the scalar has no row; the catalogue test would
  // notice one that vanished.
  if constexpr (FilterOver<F, E, typename Tile::Value>) {
    KernelRow row;
    row.name = E::Name() + "/" + std::string(F::kName) + "/" + std::string(Tile::kScalar);
    row.energy = nullptr;
    row.filter = F::kName;
    row.source = F::kSource;
    row.scalar = Tile::kScalar;
    row.output = "packed";
    row.exempt = F::kExempt;
    row.lanes = Tile::kLanes;
    row.outputs = PackedSym<typename Tile::Value, E::kDofs>::kSize;
    row.run = RunFilter<E, F, Tile>;
    rows.push_back(row);
  }
}

// A list of filter types; CMake writes the one of all filters.
template <class... F>
struct Filters {};

template <class E, class... F>
EnergyTable MakeTable(Filters<F...>) {
  static_assert(EnergyOver<E, double>);
  static_assert(EnergyOver<E, Lanes<double, kNativeLanes>>);
  EnergyTable table{MakeEnergy<E>(), {}};
  (AppendKernel<E, F, ScalarTile>(table.kernels), ...);
  (AppendKernel<E, F, LanesTile>(table.kernels), ...);
  return table;
}

}  // namespace definite
