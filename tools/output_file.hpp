#pragma once

// Files that are written whole or not at all.

#include <string>

namespace definite {

// Opens at once, so that a path that cannot be written fails before the long work, under a
// temporary name beside the path; Commit writes and renames. A path that exists and is not a
// regular file (a pipe, /dev/null) is written directly, "-" is standard output.
class OutputFile {
 public:
  // Throws UsageError if the file cannot be created.
  OutputFile(std::string option, std::string path);
  ~OutputFile();  // removes the temporary file if there was no Commit
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Throws UsageError if the disk is full or anything else goes wrong; the file at the path is then
  // as it was.
  void Commit(const std::string& content);

 private:
  [[noreturn]] void Fail(const std::string& doing) const;

  std::string option_, path_, temporary_;
  int descriptor_ = -1;
};

}  // namespace definite
