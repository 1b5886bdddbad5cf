#include "scenes/contact.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

namespace definite::scenes {

namespace {

struct Triple {
  Point e0, e1, e2;
};

Triple EdgesOf(const Contacts& contacts, std::size_t pair, const std::vector<double>& x) {
  const int* v = &contacts.vertices[4 * pair];
  const Point x0 = At(x, v[0]), x1 = At(x, v[1]), x2 = At(x, v[2]), x3 = At(x, v[3]);
  if (contacts.stencil == "vertex_face") return {x1 - x2, x3 - x2, x0 - x2};
  return {x1 - x0, x3 - x2, x2 - x0};
}

// Whether the foot of x0 lies in the triangle; e2 = b e0 + g e1 + l n.
bool IsOverFace(const Triple& t) {
  const double d00 = Dot(t.e0, t.e0), d01 = Dot(t.e0, t.e1), d11 = Dot(t.e1, t.e1);
  const double d02 = Dot(t.e0, t.e2), d12 = Dot(t.e1, t.e2);
  const double determinant = d00 * d11 - d01 * d01;
  const double b = (d11 * d02 - d01 * d12) / determinant;
  const double g = (d00 * d12 - d01 * d02) / determinant;
  return b >= 0 && g >= 0 && b + g <= 1;
}

bool HasOrientation(const std::string& length) { return length == "signed" || length == "hybrid"; }

}  // namespace

const KernelRow& KernelOf(const std::string& energy, std::string_view filter) {
  // Looked up at every step.
  static const auto kByName = [] {
    std::map<std::string, const KernelRow*> rows;
    for (const KernelRow& row : AllKernels()) rows[row.name] = &row;
    return rows;
  }();
  const std::string name = fmt::format("{}/{}/f64", energy, filter);
  if (const auto at = kByName.find(name); at != kByName.end()) return *at->second;
  throw std::runtime_error(fmt::format("a scene needs the row '{}', and there is none", name));
}

double TripleProduct(const Contacts& contacts, std::size_t pair, const std::vector<double>& x) {
  const Triple t = EdgesOf(contacts, pair, x);
  const Point c = Cross(t.e0, t.e1);
  const double area = std::sqrt(Dot(c, c));
  return area > 0 ? Dot(c, t.e2) / area : 0;
}

bool CrossFromAbove(const std::vector<double>& x, const int* edges, double& a, double& b) {
  const Point p = At(x, edges[0]), d = At(x, edges[1]) - p;
  const Point q = At(x, edges[2]), e = At(x, edges[3]) - q, r = q - p;
  const double determinant = d[0] * e[1] - d[1] * e[0];
  a = (r[0] * e[1] - r[1] * e[0]) / determinant;
  b = (r[0] * d[1] - r[1] * d[0]) / determinant;
  return a >= 0 && a < 1 && b >= 0 && b < 1;
}

Elements ContactsAt(const Contacts& contacts, const std::vector<double>& x, SideMemory& memory) {
  const std::size_t count = contacts.Size();
  memory.of_pair.resize(count, 0);
  Elements active{contacts.Energy(), {}, {}};
  if (count == 0) return active;
  // In reach by the distance of the clamped primitives, which the unsigned rows classify by.
  const bool is_face = contacts.stencil == "vertex_face";
  const EnergyRow& distance =
      *KernelOf("collision/" + contacts.stencil + (is_face ? "/unsigned" : "/unsigned_frozen") +
                    "/quadratic",
                "none")
           .energy;
  std::vector<double> all(12 * count), parameters(3 * count), classes(3 * count);
  for (std::size_t i = 0; i < 4 * count; ++i) {
    const Point at = At(x, contacts.vertices[i]);
    std::copy(at.begin(), at.end(), &all[3 * i]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    parameters[3 * i] = contacts.k;
    parameters[3 * i + 1] = contacts.eps;
    parameters[3 * i + 2] = 1;
  }
  distance.classify(all.data(), parameters.data(), classes.data(), static_cast<long>(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (classes[3 * i] == 0 || (is_face && !IsOverFace(EdgesOf(contacts, i, x)))) {
      memory.of_pair[i] = 0;
      continue;
    }
    const double triple = TripleProduct(contacts, i, x);
    const int sign = triple < 0 ? -1 : 1;
    if (memory.of_pair[i] == 0) memory.of_pair[i] = sign;
    int orientation = contacts.orientation[i];
    if (orientation == 0 || contacts.memory == Memory::kPair) orientation = memory.of_pair[i];
    // A signed length has no meaning without an orientation: it keeps the scene's.
    if (contacts.memory == Memory::kNone && contacts.length != "signed") orientation = sign;
    const int side = HasOrientation(contacts.length) ? orientation : orientation * sign;
    active.vertices.insert(active.vertices.end(), &contacts.vertices[4 * i],
                           &contacts.vertices[4 * i] + 4);
    for (const double p : {contacts.k, contacts.eps, static_cast<double>(side)}) {
      active.p.push_back(p);
    }
  }
  return active;
}

}  // namespace definite::scenes
