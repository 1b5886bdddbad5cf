#pragma once

// The report page, its scripts and its style in one text, with a mark in place of the data. Empty
// if the program was built without npm, which brings the libraries that draw.

#include <string_view>

namespace definite {

std::string_view PageTemplate();

}  // namespace definite
