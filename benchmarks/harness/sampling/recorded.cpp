#include "benchmarks/harness/sampling/recorded.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

namespace definite {

namespace {

using Json = nlohmann::ordered_json;  // names stay in their order

constexpr std::uintmax_t kMostBytes = 1'000'000'000;

// Of one line; its number is put before it where it is caught.
using LineError = RecordedError;

struct Line {
  std::uint32_t number;
  std::string_view text;
};

std::string_view Trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Calls with(part) for each part between separators, without blanks around it.
template <class With>
void ForParts(std::string_view text, char separator, With with) {
  for (std::size_t end; (end = text.find(separator)) != text.npos; text.remove_prefix(end + 1)) {
    with(Trim(text.substr(0, end)));
  }
  with(Trim(text));
}

// What a file may speak of, as the energies have it.
struct Known {
  std::map<std::string_view, const EnergyRow*> of_stencil;  // one of each
  std::vector<std::string_view> parameters;

  Known() {
    for (const EnergyRow& energy : AllEnergies()) {
      of_stencil[energy.stencil] = &energy;
      for (const Parameter& parameter : energy.parameters) {
        if (std::ranges::find(parameters, parameter.name) == parameters.end()) {
          parameters.push_back(parameter.name);
        }
      }
    }
  }

  const EnergyRow& Of(std::string_view stencil) const {
    const auto at = of_stencil.find(stencil);
    if (at != of_stencil.end()) return *at->second;
    std::vector<std::string_view> names;
    for (const auto& [name, energy] : of_stencil) names.push_back(name);
    throw LineError(fmt::format("there is no stencil '{}'; expected one of {}", stencil,
                                fmt::join(names, ", ")));
  }

  void CheckParameter(std::string_view name) const {
    if (std::ranges::find(parameters, name) != parameters.end()) return;
    throw LineError(fmt::format("no energy has a parameter '{}'; there are {}", name,
                                fmt::join(parameters, ", ")));
  }
};

// A decimal number, or a hex float. The locale has no say in it.
double Number(std::string_view text, std::string_view name) {
  const bool negative = text.starts_with('-');
  std::string_view digits = text.substr(negative ? 1 : 0);
  auto format = std::chars_format::general;
  if (digits.starts_with("0x") || digits.starts_with("0X")) {
    digits.remove_prefix(2);
    format = std::chars_format::hex;
  }
  double value = 0;
  const char* const last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, value, format);
  if (end != last || error != std::errc() || !std::isfinite(value) || digits.starts_with('-')) {
    throw LineError(fmt::format("{} is '{}'; expected a finite number", name, text));
  }
  return negative ? -value : value;
}

// Lines of one form. The settings are read first, then the configurations, by several threads.
class Reader {
 public:
  virtual ~Reader() = default;
  // Reads what stands before the first configuration; `at` is then its line, and, where LineError
  // is thrown, the line with the error.
  virtual void ReadSettings(std::span<const Line> lines, std::size_t& at) = 0;
  // The numbers of one line: coordinates, and parameters by their place in Names(). Throws
  // LineError.
  virtual void ReadConfiguration(std::string_view text, double* x, double* p) const = 0;

  const std::string& Stencil() const { return stencil_; }
  int Dofs() const { return dofs_; }
  int Dimension() const { return dimension_; }
  const std::vector<std::string>& Names() const { return names_; }
  // Values of the first parameters: those that all lines share.
  const std::vector<double>& Shared() const { return shared_; }

 protected:
  void SetStencil(std::string_view name) {
    const EnergyRow& energy = known_.Of(name);
    CheckStencil(name);
    stencil_ = name;
    dofs_ = energy.dofs;
    dimension_ = energy.dimension;
  }

  void CheckStencil(std::string_view name) const {
    if (stencil_.empty() || name == stencil_) return;
    throw LineError(
        fmt::format("'{}' in a file of {}; expected one stencil in a file", name, stencil_));
  }

  void NeedStencil(std::string_view how) const {
    if (stencil_.empty())
      throw LineError(fmt::format("the stencil is not known; expected {}", how));
  }

  // Returns its place.
  std::size_t AddParameter(std::string_view name) {
    known_.CheckParameter(name);
    if (std::ranges::find(names_, name) != names_.end()) {
      throw LineError(fmt::format("{} stands there twice", name));
    }
    names_.emplace_back(name);
    return names_.size() - 1;
  }

  void Share(std::string_view name, double value) {
    AddParameter(name);
    shared_.push_back(value);
  }

 private:
  Known known_;
  std::string stencil_;
  int dofs_ = 0, dimension_ = 0;
  std::vector<std::string> names_;
  std::vector<double> shared_;
};

class CsvReader : public Reader {
 public:
  void ReadSettings(std::span<const Line> lines, std::size_t& at) override {
    for (at = 0; at < lines.size() && lines[at].text.starts_with('#'); ++at) {
      ForParts(lines[at].text.substr(1), ' ', [&](std::string_view word) { ReadSetting(word); });
    }
    if (at == lines.size()) {
      --at;
      throw LineError("expected a head below it, such as x0,y0,z0,x1,...");
    }
    ReadHead(lines[at].text);
    ++at;
  }

  void ReadConfiguration(std::string_view text, double* x, double* p) const override {
    if (text.starts_with('#')) {
      throw LineError(fmt::format("'{}' below the head; expected numbers", text));
    }
    std::size_t column = 0;
    ForParts(text, ',', [&](std::string_view part) {
      if (column < columns_.size()) {
        const Column& to = columns_[column];
        (to.is_parameter ? p : x)[to.place] = Number(part, to.name);
      }
      ++column;
    });
    if (column != columns_.size()) {
      throw LineError(
          fmt::format("{} columns; expected {}, as in the head", column, columns_.size()));
    }
  }

 private:
  struct Column {
    std::string name;
    bool is_parameter;
    std::size_t place;
  };

  void ReadSetting(std::string_view word) {
    const std::size_t equals = word.find('=');
    if (equals == word.npos) return;  // a remark
    const std::string_view name = word.substr(0, equals), value = word.substr(equals + 1);
    if (name == "stencil") {
      SetStencil(value);
    } else {
      Share(name, Number(value, name));
    }
  }

  void ReadHead(std::string_view text) {
    NeedStencil("a line above the head: # stencil=edge_edge");
    const std::vector<std::string> coordinates = CoordinateNames(Dofs(), Dimension());
    std::vector<std::string> missing = coordinates;
    ForParts(text, ',', [&](std::string_view name) {
      const auto at = std::ranges::find(coordinates, name);
      if (at == coordinates.end()) {
        columns_.push_back({std::string(name), true, AddParameter(name)});
        return;
      }
      if (std::erase(missing, name) == 0) {
        throw LineError(fmt::format("{} stands there twice", name));
      }
      columns_.push_back({*at, false, static_cast<std::size_t>(at - coordinates.begin())});
    });
    if (!missing.empty()) {
      throw LineError(fmt::format("the head lacks {}; a {} has {}", fmt::join(missing, ", "),
                                  Stencil(), fmt::join(coordinates, ",")));
    }
  }

  std::vector<Column> columns_;
};

class JsonReader : public Reader {
 public:
  void ReadSettings(std::span<const Line> lines, std::size_t& at) override {
    at = 0;
    if (const Json first = ObjectOf(lines[at].text); !first.contains("x")) {
      for (const auto& [name, value] : first.items()) {
        if (name != "stencil") Share(name, NumberOf(value, name));
      }
      if (first.contains("stencil")) SetStencil(StencilOf(first));
      if (lines.size() == 1) throw LineError("expected configurations below the settings");
      ++at;
    }
    const Json next = ObjectOf(lines[at].text);
    if (next.contains("stencil")) SetStencil(StencilOf(next));
    NeedStencil(R"("stencil": "edge_edge" in the first line)");
    for (const auto& [name, value] : next.items()) {
      if (name != "stencil" && name != "x") AddParameter(name);
    }
  }

  void ReadConfiguration(std::string_view text, double* x, double* p) const override {
    Fields fields(*this, x, p);
    if (!Json::sax_parse(text, &fields)) throw NotAnObject();
    fields.CheckNumbers();
  }

 private:
  // Takes the numbers of a line as they are read: a document of each would take thrice the time.
  class Fields : public nlohmann::json_sax<Json> {
   public:
    Fields(const JsonReader& reader, double* x, double* p) : reader_(&reader), x_(x), p_(p) {}

    void CheckNumbers() const {
      const auto expected = static_cast<std::size_t>(reader_->Dofs());
      if (coordinates_ != expected) {
        throw LineError(fmt::format("x has {} numbers; expected {} for a {}", coordinates_,
                                    expected, reader_->Stencil()));
      }
      const std::size_t parameters = reader_->Names().size() - reader_->Shared().size();
      if (parameters_ != parameters) {
        throw LineError(fmt::format("{} parameters; expected {}, as in the lines above",
                                    parameters_, parameters));
      }
    }

    bool key(string_t& name) override {
      name_ = name;
      if (name == "x") coordinates_ = 0;
      if (name == "stencil" || name == "x") return true;
      const auto& names = reader_->Names();
      const auto at = std::find(names.begin() + std::ssize(reader_->Shared()), names.end(), name);
      if (at == names.end()) {
        throw LineError(fmt::format("'{}'; expected the same names as in the lines above", name));
      }
      place_ = at - names.begin();
      return true;
    }
    bool number_integer(number_integer_t value) override {
      return Take(static_cast<double>(value));
    }
    bool number_unsigned(number_unsigned_t value) override {
      return Take(static_cast<double>(value));
    }
    bool number_float(number_float_t value, const string_t&) override { return Take(value); }
    bool string(string_t& value) override {
      if (name_ != "stencil") throw NotANumber(fmt::format("\"{}\"", value));
      reader_->CheckStencil(value);
      return true;
    }
    bool start_array(std::size_t) override {
      if (name_ != "x" || in_array_) throw NotANumber("an array");
      return in_array_ = true;
    }
    bool end_array() override {
      in_array_ = false;
      return true;
    }
    bool start_object(std::size_t) override {
      if (!name_.empty()) throw NotANumber("an object");
      return is_object_ = true;
    }
    bool end_object() override { return true; }
    bool null() override { throw NotANumber("null"); }
    bool boolean(bool value) override { throw NotANumber(value ? "true" : "false"); }
    bool binary(binary_t&) override { return false; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
      return false;
    }

   private:
    LineError NotANumber(std::string_view what) const {
      if (!is_object_) return NotAnObject();
      const bool is_list = name_ == "x" && !in_array_;
      return LineError(fmt::format("{} is {}; expected {}", name_, what,
                                   name_ == "stencil" ? "a name"
                                   : is_list          ? "an array"
                                                      : "a number"));
    }

    bool Take(double value) {
      if (!is_object_ || name_ == "stencil" || (name_ == "x") != in_array_) {
        throw NotANumber("a number");
      }
      if (name_ != "x") {
        p_[place_] = value;
        ++parameters_;
      } else {
        if (coordinates_ < static_cast<std::size_t>(reader_->Dofs())) x_[coordinates_] = value;
        ++coordinates_;
      }
      return true;
    }

    const JsonReader* reader_;
    double *x_, *p_;
    std::string name_;
    std::ptrdiff_t place_ = 0;
    bool is_object_ = false, in_array_ = false;
    std::size_t coordinates_ = 0, parameters_ = 0;
  };

  static Json ObjectOf(std::string_view text) {
    Json json = Json::parse(text, nullptr, false);
    if (json.is_object()) return json;
    throw NotAnObject();
  }

  static LineError NotAnObject() {
    return LineError("not a JSON object; expected one in each line, with finite numbers");
  }

  static double NumberOf(const Json& value, std::string_view name) {
    if (value.is_number()) return value.get<double>();
    throw LineError(fmt::format("{} is {}; expected a number", name, value.dump()));
  }

  static std::string StencilOf(const Json& json) {
    const Json& name = json.at("stencil");
    return name.is_string() ? name.get<std::string>() : name.dump();
  }
};

std::string ReadText(const std::string& path) {
  const auto fail = [&](const std::string& what) -> RecordedError {
    return RecordedError(fmt::format("{}: {}", path, what));
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw fail("there is no such file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw fail(error.message());
  if (size > kMostBytes) {
    throw fail(
        fmt::format("{:.1f} GB; expected at most {:.0f}: take a sample of its lines, as "
                    "`shuf -n 1000000` does",
                    static_cast<double>(size) / 1e9, static_cast<double>(kMostBytes) / 1e9));
  }
  std::string text(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(text.data(), static_cast<std::streamsize>(size))) throw fail("cannot read it");
  return text;
}

// Those that are not empty.
std::vector<Line> LinesOf(std::string_view text) {
  std::vector<Line> lines;
  std::uint32_t number = 0;
  ForParts(text, '\n', [&](std::string_view line) {
    ++number;
    if (!line.empty()) lines.push_back({number, line});
  });
  return lines;
}

std::uint64_t DigestOf(const Recorded& recorded) {
  std::uint64_t digest = StreamId(recorded.stencil);
  const auto add = [&](std::uint64_t bits) { digest = (digest ^ bits) * 0x9e3779b97f4a7c15; };
  for (const std::string& name : recorded.parameters) add(StreamId(name));
  for (const auto* numbers : {&recorded.x, &recorded.p}) {
    for (const double number : *numbers) {
      add(std::bit_cast<std::uint64_t>(number));
      digest ^= digest >> 32;
    }
  }
  return digest;
}

}  // namespace

void Recorded::Take(const DrawTarget& target, std::uint64_t index, double* x_out,
                    double* p_out) const {
  const std::uint64_t i = index % Size();
  std::copy_n(x.data() + i * static_cast<std::uint64_t>(dofs), dofs, x_out);
  for (const Parameter& parameter : target.parameters) {
    const auto at = std::ranges::find(parameters, parameter.name);
    *p_out++ = at == parameters.end()
                   ? parameter.value
                   : p[i * parameters.size() + static_cast<std::size_t>(at - parameters.begin())];
  }
}

std::vector<std::string> CoordinateNames(int dofs, int dimension) {
  std::vector<std::string> names;
  for (int i = 0; i < dofs; ++i) {
    names.push_back(fmt::format("{}{}", "xyz"[i % dimension], i / dimension));
  }
  return names;
}

bool IsRecorded(std::string_view name) {
  return name.ends_with(".csv") || name.ends_with(".jsonl");
}

Recorded ReadRecorded(const std::string& path) {
  const std::string text = ReadText(path);
  const std::vector<Line> lines = LinesOf(text);
  const auto fail = [&](const Line& line, const LineError& error) {
    return RecordedError(fmt::format("{}:{}: {}", path, line.number, error.what()));
  };
  if (lines.empty()) throw RecordedError(path + ": it is empty; expected configurations");
  std::unique_ptr<Reader> reader;
  if (path.ends_with(".csv")) {
    reader = std::make_unique<CsvReader>();
  } else {
    reader = std::make_unique<JsonReader>();
  }
  std::size_t first = 0;
  try {
    reader->ReadSettings(lines, first);
  } catch (const LineError& error) {
    throw fail(lines[first], error);
  }
  const std::span<const Line> configurations = std::span(lines).subspan(first);
  if (configurations.empty()) {
    throw RecordedError(path + ": it has no configurations; expected numbers below the head");
  }

  const std::size_t size = configurations.size(), dofs = static_cast<std::size_t>(reader->Dofs()),
                    parameters = reader->Names().size();
  Recorded recorded = {reader->Stencil(), reader->Dofs(), reader->Names(), {}, {}, {}, 0};
  recorded.x.resize(size * dofs);
  recorded.p.resize(size * parameters);
  recorded.lines.resize(size);
  // The first line with an error is the one to tell.
  std::map<std::size_t, LineError> errors;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < size; ++i) {
    double* p = recorded.p.data() + i * parameters;
    std::ranges::copy(reader->Shared(), p);
    recorded.lines[i] = configurations[i].number;
    try {
      reader->ReadConfiguration(configurations[i].text, recorded.x.data() + i * dofs, p);
    } catch (const LineError& error) {
#pragma omp critical
      errors.emplace(i, error);
    }
  }
  if (!errors.empty()) {
    throw fail(configurations[errors.begin()->first], errors.begin()->second);
  }
  recorded.digest = DigestOf(recorded);
  return recorded;
}

}  // namespace definite
