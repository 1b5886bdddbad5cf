// Writes the contacts of a simulator for `definite advise contacts.csv`: put the function where they
// are known, once a step. Vertices are in definite's order: edges (0, 1) and (2, 3), or a vertex 0
// and a face 1, 2, 3, with n = (x1 - x2) x (x3 - x2) on the side where it is free.
#include <cstdio>

void WriteContact(std::FILE* file, const double (&x)[4][3]) {
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      std::fprintf(file, "%.17g%c", x[i][k], i == 3 && k == 2 ? '\n' : ',');
    }
  }
}

int main() {
  std::FILE* file = std::fopen("contacts.csv", "w");
  if (!file) return 1;
  std::fputs("# stencil=edge_edge k=1000 eps=0.01\n", file);  // what all contacts share
  std::fputs("x0,y0,z0,x1,y1,z1,x2,y2,z2,x3,y3,z3\n", file);
  WriteContact(file, {{0, 0, 0}, {1, 0, 0}, {0.5, -0.5, 0.008}, {0.5, 0.5, 0.008}});
  WriteContact(file, {{0, 0, 0}, {1, 0, 0}, {0.2, -0.5, -0.002}, {0.9, 0.5, 0.001}});
  return std::fclose(file) == 0 ? 0 : 1;
}
