#pragma once

// The processes of one MPI run. Without MPI, or outside mpirun, there is one.

#include <string>
#include <vector>

#include "benchmarks/harness/blocks.hpp"

namespace definite {

class Ranks {
 public:
  // Starts MPI if the program was built with it (DEFINITE_MPI) and a launcher is there; once.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  bool Shared() const { return mine_.count > 1; }
  bool First() const { return mine_.index == 1; }
  Shard Mine() const { return mine_; }

  // The texts of all ranks, in their order, on the first one; nothing on the others.
  std::vector<std::string> Gather(const std::string& text) const;

 private:
  Shard mine_;
};

}  // namespace definite
