#pragma once

// Markdown tables that read well as plain text too.

#include <string>
#include <vector>

namespace definite {

// Pads every cell; the first column is set to the left, the others to the right. The first row is
// the head.
std::string MarkdownTable(const std::vector<std::vector<std::string>>& rows);

// Breaks a paragraph at spaces, so that no line is longer than `width`.
std::string Wrapped(const std::string& paragraph, std::size_t width, const std::string& indent);

}  // namespace definite
