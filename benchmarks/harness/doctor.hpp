#pragma once

// Whether times measured on this machine can be trusted, and for what.

#include <optional>
#include <string>
#include <vector>

namespace definite {

enum class Trust { kGood, kCare, kBad };

struct Symptom {
  std::string name, found, means;
  Trust trust;
};

struct Diagnosis {
  std::vector<Symptom> symptoms;
  // Of an A/A run: half the rounds put a row further from itself than `typical`, one in twenty
  // further than `floor`. 0.02 is 2 %.
  double typical, floor;
  std::vector<Symptom> verdicts;  // of what a number may be used for
};

// Where the kernel describes the machine: "/", or a folder of a test's.
Diagnosis Diagnose(const std::string& root = "/");

}  // namespace definite
