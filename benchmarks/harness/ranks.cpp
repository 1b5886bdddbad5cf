#include "benchmarks/harness/ranks.hpp"

#ifdef DEFINITE_MPI

#include <mpi.h>

#include <cstdlib>
#include <exception>

namespace definite {

namespace {

// Alone, MPI would take half a second to start.
bool Launched() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE") || std::getenv("PMIX_RANK");
}

}  // namespace

Ranks::Ranks() {
  if (!Launched()) return;
  int rank = 0, size = 1;
  MPI_Init(nullptr, nullptr);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  mine_ = {static_cast<std::uint64_t>(rank) + 1, static_cast<std::uint64_t>(size)};
}

Ranks::~Ranks() {
  int started = 0;
  MPI_Initialized(&started);
  // An error on one rank leaves the others waiting for what it never sends: a process that ends
  // without this call makes the launcher end them too.
  if (started && std::uncaught_exceptions() == 0) MPI_Finalize();
}

std::vector<std::string> Ranks::Gather(const std::string& text) const {
  const auto size = static_cast<int>(text.size());
  const std::size_t count = First() ? mine_.count : 0;
  std::vector<int> sizes(count), offsets(count);
  MPI_Gather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  int total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    offsets[i] = total;
    total += sizes[i];
  }
  std::string all(static_cast<std::size_t>(total), '\0');
  MPI_Gatherv(text.data(), size, MPI_CHAR, all.data(), sizes.data(), offsets.data(), MPI_CHAR, 0,
              MPI_COMM_WORLD);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.push_back(
        all.substr(static_cast<std::size_t>(offsets[i]), static_cast<std::size_t>(sizes[i])));
  }
  return texts;
}

}  // namespace definite

#else

namespace definite {

Ranks::Ranks() = default;
Ranks::~Ranks() = default;
std::vector<std::string> Ranks::Gather(const std::string& text) const { return {text}; }

}  // namespace definite

#endif
