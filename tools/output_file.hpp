#pragma once

// Files that are written whole or not at all.

#include <string>

namespace definite {

// Commit writes to a temporary name beside the path and renames. The constructor tries that name,
// so that a path that cannot be written fails before the long work, and leaves nothing behind. A
// path that exists and is not a regular file (a pipe, /dev/null) is opened at once and written
// directly, "-" is standard output.
class OutputFile {
 public:
  // Throws UsageError if the file cannot be created.
  OutputFile(std::string option, std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // May be called again: the file at the path is the last one. Throws UsageError if the disk is
  // full or anything else goes wrong; the file at the path is then as it was.
  void Commit(const std::string& content);

 private:
  void CreateTemporary();
  void RemoveTemporary();
  [[noreturn]] void Fail(const std::string& doing) const;

  std::string option_, path_;
  std::string target_, temporary_;  // a temporary file that exists
  int descriptor_ = -1;
};

}  // namespace definite
