# Writes build_info.hpp; left untouched if nothing changed, so that nothing is built anew.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#pragma once

namespace definite::build_info {
inline constexpr const char* kCompiler = "@DEFINITE_COMPILER@";
inline constexpr const char* kFlags = "@DEFINITE_FLAGS@";
inline constexpr const char* kType = "@DEFINITE_TYPE@";
inline constexpr const char* kProtocol = "@DEFINITE_PROTOCOL@";
inline constexpr const char* kCommit = "@commit@";
}  // namespace definite::build_info
]])
