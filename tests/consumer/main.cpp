// Filters the Hessians of eight contacts in both ways that definite offers, and sees that they
// agree bit for bit. A solver needs one of the two.

#include <cstdio>

#include "kernels/energies/collision_signed.hpp"  // for the templates
#include "kernels/filters/nearest.hpp"
#include "kernels/kernel.hpp"  // for the table

using Contact = definite::Collision<definite::Signed<definite::VertexFace>, definite::Quadratic>;

constexpr int kDofs = Contact::kDofs;      // a vertex, and the three of the triangle below it
constexpr int kParams = Contact::kParams;  // k, eps, side: see Contact::kParameters
constexpr int kEntries = definite::PackedSym<double, kDofs>::kSize;
constexpr int kContacts = 8;

int main() {
  // The table works on tiles of eight contacts side by side: x[i][c] is number i of contact c.
  double x[kDofs][kContacts], p[kParams][kContacts], filtered[kEntries][kContacts];
  for (int c = 0; c < kContacts; ++c) {
    const double height = 0.25 * c - 0.875;
    const double vertices[kDofs] = {0.2, 0.3, height, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    const double parameters[kParams] = {1e3, 1, 0};
    for (int i = 0; i < kDofs; ++i) x[i][c] = vertices[i];
    for (int i = 0; i < kParams; ++i) p[i][c] = parameters[i];
  }

  // By the table: energy and filter are chosen by name when the program runs.
  const definite::KernelRow* row =
      definite::FindKernel("collision/vertex_face/signed/quadratic/nearest/f64x8");
  if (!row) {
    std::fputs("this build of definite has no such row\n", stderr);
    return 1;
  }
  row->run(x[0], p[0], filtered[0], 1);  // one tile

  double trace = 0;
  int differing = 0;
  for (int c = 0; c < kContacts; ++c) {
    definite::Vec<double, kDofs> one_x;
    definite::Vec<double, kParams> one_p;
    for (int i = 0; i < kDofs; ++i) one_x[i] = x[i][c];
    for (int i = 0; i < kParams; ++i) one_p[i] = p[i][c];

    // By the templates: inlined where the solver wants it. Lanes<double, kNativeLanes> instead of
    // double filters as many contacts at once as a machine vector holds.
    const auto h = definite::ToPacked(definite::Nearest::Apply<Contact>(one_x, one_p));

    int k = 0;  // the upper triangle, row by row
    for (int i = 0; i < kDofs; ++i) {
      for (int j = i; j < kDofs; ++j, ++k) {
        if (i == j) trace += h.a[k];
        if (h.a[k] != filtered[k][c]) ++differing;
      }
    }
  }
  std::printf("%d contacts: trace of the filtered Hessians %.6g, %d entries differ\n", kContacts,
              trace, differing);
  return differing == 0 ? 0 : 1;
}
