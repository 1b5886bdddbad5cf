// The families driven by libFuzzer: bytes are an energy, a family and genes; what it looks for are
// larger defects. A promise that is broken is printed as a file of fuzz/corpus, and aborts.
//
//   fuzz_bytes -max_total_time=600 FOLDER     hunts, and keeps what is interesting in FOLDER
//   fuzz_bytes FILE                           looks at one input again

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <random>

#include "benchmarks/harness/examine.hpp"
#include "benchmarks/harness/promises.hpp"
#include "fuzz/findings.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace definite::fuzz {

namespace {

// One for each figure of each row, by powers of two: to reach another is as good as a new branch.
// Kernels have none.
__attribute__((section("__libfuzzer_extra_counters"))) std::uint8_t reached[1 << 18];

// What the bytes are.
struct Tuple {
  std::uint8_t energy, family, pose, sign;
  std::uint32_t delta;  // of 2^32: 0 is 0, else log-uniform
  std::array<std::uint32_t, 12> u;
};

double OpenUniform(std::uint32_t bits) { return (bits + 0.5) / 0x1p32; }

Genes GenesOf(const Tuple& tuple) {
  Genes genes;
  genes.delta = tuple.delta == 0 ? 0 : std::pow(10.0, -16 * OpenUniform(tuple.delta));
  genes.negative = tuple.sign % 2 == 1;
  genes.pose = static_cast<Genes::Pose>(tuple.pose % 3);
  std::ranges::transform(tuple.u, genes.u.begin(), OpenUniform);
  return genes;
}

struct Judge {
  std::vector<const KernelRow*> rows;
  std::unique_ptr<Examiner> examiner;
};

Judge& JudgeOf(const EnergyRow& energy) {
  static std::map<const EnergyRow*, Judge> judges;
  Judge& judge = judges[&energy];
  if (!judge.examiner) {
    for (const KernelRow& row : AllKernels()) {
      if (row.energy == &energy) judge.rows.push_back(&row);
    }
    judge.examiner = std::make_unique<Examiner>(energy, judge.rows);
  }
  return judge;
}

void Reach(std::size_t row, std::size_t figure, std::optional<double> value) {
  if (!value || !(*value > 0)) return;
  const int bucket = std::isfinite(*value) ? std::clamp(std::ilogb(*value) + 64, 1, 127) : 0;
  reached[((row * 4 + figure) * 128 + static_cast<std::size_t>(bucket)) % sizeof(reached)] = 1;
}

void Look(const Tuple& tuple) {
  const EnergyRow& energy = AllEnergies()[tuple.energy % AllEnergies().size()];
  std::vector<const Family*> families;
  for (const Family& family : AllFamilies()) {
    if (family.Has(energy.stencil)) families.push_back(&family);
  }
  const Family& family = *families[tuple.family % families.size()];
  const Example example = ExampleOf(energy, family, GenesOf(tuple));
  Judge& judge = JudgeOf(energy);
  // Definitions take a thousand times longer.
  Depth depth = Depth::kSpectral;
  depth.definition = tuple.u[0] % 16 == 0;
  judge.examiner->Examine(example.x.data(), example.p.data(), depth);
  const auto first = static_cast<std::size_t>(judge.rows.front() - AllKernels().data());
  for (std::size_t r = 0; r < judge.rows.size(); ++r) {
    const RowFigures& figures = judge.examiner->Row(r);
    Reach(first + r, 0, figures.psd_defect);
    Reach(first + r, 1, figures.distance);
    Reach(first + r, 2, figures.relabelling);
    Reach(first + r, 3, figures.conditioned_rounding);
    if (figures.broken.empty()) continue;
    const std::string what(PropertyName(figures.broken.front()));
    std::fputs(CorpusText(fmt::format("fuzz_bytes, {} of {}", family.name, judge.rows[r]->name),
                          what, energy, example)
                   .c_str(),
               stderr);
    std::abort();
  }
}

}  // namespace

}  // namespace definite::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  definite::fuzz::Tuple tuple{};
  std::memcpy(&tuple, data, std::min(size, sizeof(tuple)));
  definite::fuzz::Look(tuple);
  return 0;
}

// Changes one part of the tuple; now and then bytes, whatever they are.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using definite::fuzz::Tuple;
  if (max_size < sizeof(Tuple)) return size;
  std::minstd_rand random(seed);
  Tuple tuple{};
  std::memcpy(&tuple, data, std::min(size, sizeof(tuple)));
  const auto draw = [&] { return static_cast<std::uint32_t>(random()); };
  switch (draw() % 8) {
    case 0:
      tuple.energy = static_cast<std::uint8_t>(draw());
      break;
    case 1:
      tuple.family = static_cast<std::uint8_t>(draw());
      break;
    case 2:
      tuple.pose = static_cast<std::uint8_t>(draw());
      break;
    case 3:
      tuple.sign ^= 1;
      break;
    case 4:
      tuple.delta = draw() % 16 == 0 ? 0 : draw() * 2;
      break;
    case 5:
      tuple.delta += draw() % 0x20000000 - 0x10000000;
      break;  // a decade, about
    case 6:
      tuple.u[draw() % 12] = draw() * 2;
      break;
    default:
      std::memcpy(data, &tuple, sizeof(tuple));
      return LLVMFuzzerMutate(data, sizeof(tuple), sizeof(tuple));
  }
  std::memcpy(data, &tuple, sizeof(tuple));
  return sizeof(tuple);
}
