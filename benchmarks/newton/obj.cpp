#include "benchmarks/newton/obj.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

namespace definite::newton {

namespace {

std::vector<std::string> WordsOf(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

class Reader {
 public:
  Mesh Read(std::istream& stream) {
    for (std::string line; std::getline(stream, line);) {
      ++line_;
      const std::vector<std::string> words = WordsOf(line);
      if (words.empty()) continue;
      if (words.front() == "v") AddVertex(words);
      if (words.front() == "f") AddPolygon(words);
    }
    if (mesh_.elements.empty()) throw MeshError("expected lines that begin with f, found none");
    return std::move(mesh_);
  }

 private:
  template <class... Arguments>
  [[noreturn]] void Fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw MeshError(fmt::format("line {}: {}", line_,
                                fmt::format(format, std::forward<Arguments>(arguments)...)));
  }

  void AddVertex(const std::vector<std::string>& words) {
    if (words.size() < 4) Fail("expected three coordinates, found {}", words.size() - 1);
    Point point;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string& word = words[i + 1];
      const char* const end = word.data() + word.size();
      const auto [stop, error] = std::from_chars(word.data(), end, point[i]);
      if (error != std::errc() || stop != end || !std::isfinite(point[i])) {
        Fail("'{}': expected a coordinate", word);
      }
    }
    mesh_.rest.push_back(point);
  }

  // "7", "7/1", "7//3", "7/1/3"; below 0 it counts back from the last vertex.
  int VertexOf(const std::string& word) const {
    int number = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, number);
    const int count = mesh_.Vertices();
    if (error != std::errc() || (stop != end && *stop != '/')) {
      Fail("'{}': expected the number of a vertex", word);
    }
    const int vertex = number < 0 ? count + number : number - 1;
    if (number == 0 || vertex < 0 || vertex >= count) {
      Fail("'{}': expected a vertex from 1 to {}", word, count);
    }
    return vertex;
  }

  void AddPolygon(const std::vector<std::string>& words) {
    std::vector<int> polygon;
    for (std::size_t i = 1; i < words.size(); ++i) {
      polygon.push_back(VertexOf(words[i]));
      if (std::ranges::count(polygon, polygon.back()) > 1) {
        Fail("'{}': expected each vertex of a polygon once", words[i]);
      }
    }
    if (polygon.size() < 3) Fail("expected three vertices or more, found {}", polygon.size());
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      mesh_.elements.insert(mesh_.elements.end(), {polygon[0], polygon[i - 1], polygon[i]});
      if (!(MeasureOf(mesh_, mesh_.Elements() - 1) > 0)) {
        Fail("expected a triangle with an area, found none in vertices {}, {} and {}",
             polygon[0] + 1, polygon[i - 1] + 1, polygon[i] + 1);
      }
    }
  }

  Mesh mesh_;
  int line_ = 0;
};

}  // namespace

Mesh ReadObj(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) throw MeshError("cannot read it");
  return Reader().Read(stream);
}

}  // namespace definite::newton
