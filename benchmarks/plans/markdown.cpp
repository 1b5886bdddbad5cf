#include "benchmarks/plans/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace definite {

std::string MarkdownTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 3);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string table;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < widths.size(); ++c) {
      table += c == 0 ? fmt::format("| {:<{}} ", rows[r][c], widths[c])
                      : fmt::format("| {:>{}} ", rows[r][c], widths[c]);
    }
    table += "|\n";
    if (r > 0) continue;
    for (std::size_t c = 0; c < widths.size(); ++c) {
      table += c == 0 ? fmt::format("|{:-<{}}", "", widths[c] + 2)
                      : fmt::format("|{:-<{}}:", "", widths[c] + 1);
    }
    table += "|\n";
  }
  return table;
}

std::string Wrapped(const std::string& paragraph, std::size_t width, const std::string& indent) {
  std::istringstream words(paragraph);
  std::string text, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      text += line + "\n";
      line = indent;
    }
    line += (line.empty() || line == indent ? "" : " ") + word;
  }
  return text + line + "\n";
}

}  // namespace definite
