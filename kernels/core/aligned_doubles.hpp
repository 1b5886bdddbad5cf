#pragma once

#include <cstddef>
#include <vector>

namespace definite {

// Doubles that start at a cache line, as lanes like them.
class AlignedDoubles {
 public:
  void Resize(std::size_t count) { lines_.resize((count + 7) / 8); }
  double* Data() { return lines_.empty() ? nullptr : lines_.front().numbers; }
  const double* Data() const { return lines_.empty() ? nullptr : lines_.front().numbers; }

 private:
  struct alignas(64) CacheLine {
    double numbers[8];
  };
  std::vector<CacheLine> lines_;
};

}  // namespace definite
