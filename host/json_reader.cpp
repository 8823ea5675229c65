/* json_reader.cpp - see json_reader.h. */
#include "host/json_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "host/round_to_float.h"

namespace tandem {
namespace {

std::string joined(std::span<const char *const> names)
{
  std::string text;
  for (const char *name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

/* The value as it stands in the file, shortened, for messages. */
std::string shown(const nlohmann::json &value)
{
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

/* std::from_chars takes hexadecimal digits without the 0x that strtof and printf("%a") have. */
template <class Real> std::optional<Real> parse_hex_float(const std::string &text)
{
  size_t start = !text.empty() && text[0] == '-' ? 1 : 0;
  if (text.compare(start, 2, "0x") != 0 || text.size() < start + 3 ||
      !std::isxdigit(static_cast<unsigned char>(text[start + 2])))
    return {};
  Real magnitude = 0;
  auto [end, error] =
      std::from_chars(text.data() + start + 2, text.data() + text.size(), magnitude, std::chars_format::hex);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return start ? -magnitude : magnitude;
}

/* While parsing. Duplicate keys would silently lose a value, since the parser keeps the last; depth would end in a full stack. */
class StrictParsing {
public:
  explicit StrictParsing(const std::string &where) : where_(where) {}

  bool operator()(int depth, nlohmann::json::parse_event_t event, nlohmann::json &parsed)
  {
    using Event = nlohmann::json::parse_event_t;
    if ((event == Event::object_start || event == Event::array_start) && depth >= most_json_levels)
      throw InputError(fmt::format("{}: arrays and objects stand more than {} deep within one another; no scene needs that", where_, most_json_levels));
    if (event == Event::object_start) open_.emplace_back();
    if (event == Event::object_end) open_.pop_back();
    if (event == Event::key && !open_.back().insert(parsed.get_ref<const std::string &>()).second)
      throw InputError(fmt::format("{}: the key {} stands twice in one object", where_, parsed.dump()));
    return true;
  }

private:
  const std::string &where_;
  std::vector<std::set<std::string>> open_;
};

std::string line_and_column(const std::string &text, size_t byte)
{
  size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
  size_t line = 1 + size_t(std::count(text.begin(), text.begin() + ptrdiff_t(end), '\n'));
  size_t start = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  return fmt::format("{}:{}", line, start == std::string::npos ? end + 1 : end - start);
}

/* Without the library's own prefix and position. */
std::string plain_reason(const std::string &what)
{
  size_t column = what.find("column ");
  size_t colon = column == std::string::npos ? std::string::npos : what.find(": ", column);
  if (colon != std::string::npos) return what.substr(colon + 2);
  size_t bracket = what.find("] ");
  return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

} // namespace

void JsonValue::fail(const std::string &message) const
{
  throw InputError(path_.empty() ? fmt::format("{}: {}", *where_, message)
                                 : fmt::format("{}: {}: {}", *where_, path_, message));
}

std::optional<JsonValue> JsonValue::find(const char *key) const
{
  if (!value_->is_object()) fail(fmt::format("is {}; an object is needed", shown(*value_)));
  auto member = value_->find(key);
  if (member == value_->end()) return {};
  return JsonValue(*member, *where_, path_.empty() ? key : path_ + "." + key, floats_);
}

JsonValue JsonValue::member(const char *key) const
{
  std::optional<JsonValue> found = find(key);
  if (!found) fail(fmt::format("\"{}\" is missing", key));
  return *found;
}

void JsonValue::only_keys(std::span<const char *const> known) const
{
  if (!value_->is_object()) fail(fmt::format("is {}; an object is needed", shown(*value_)));
  for (const auto &[key, value] : value_->items())
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      std::string place = path_.empty() ? key : path_ + "." + key;
      throw InputError(fmt::format("{}: {}: unknown key; known here: {}", *where_, place, joined(known)));
    }
}

size_t JsonValue::array_size() const
{
  if (!value_->is_array()) fail(fmt::format("is {}; an array is needed", shown(*value_)));
  return value_->size();
}

JsonValue JsonValue::element(size_t index) const
{
  return {(*value_)[index], *where_, fmt::format("{}[{}]", path_, index), floats_};
}

template <class Real> Real JsonValue::number_of() const
{
  if (value_->is_string() && floats_ == JsonFloats::numbers_and_hexadecimal) {
    std::optional<Real> parsed = parse_hex_float<Real>(value_->get_ref<const std::string &>());
    if (parsed && std::isfinite(*parsed)) return *parsed;
    fail(fmt::format("is {}; a number or a finite hexadecimal float such as \"0x1.8p+1\" is needed", shown(*value_)));
  }
  if (!value_->is_number()) fail(fmt::format("is {}; a number is needed", shown(*value_)));
  const auto result = value_->get<double>();
  if (!std::isfinite(round_to_float(result))) fail(fmt::format("is {}; no finite 32-bit float holds that", shown(*value_)));
  return Real(result);
}

float JsonValue::number() const { return number_of<float>(); }
double JsonValue::precise_number() const { return number_of<double>(); }

Vec3 JsonValue::vec3() const
{
  if (array_size() != 3) fail(fmt::format("is {}; an array of 3 numbers is needed", shown(*value_)));
  return {element(0).number(), element(1).number(), element(2).number()};
}

Point JsonValue::point() const
{
  if (array_size() != 3) fail(fmt::format("is {}; an array of 3 numbers is needed", shown(*value_)));
  return {element(0).precise_number(), element(1).precise_number(), element(2).precise_number()};
}

Quat JsonValue::quat() const
{
  if (array_size() != 4) fail(fmt::format("is {}; an array of 4 numbers (x, y, z, w) is needed", shown(*value_)));
  return {element(0).number(), element(1).number(), element(2).number(), element(3).number()};
}

bool JsonValue::boolean() const
{
  if (!value_->is_boolean()) fail(fmt::format("is {}; true or false is needed", shown(*value_)));
  return value_->get<bool>();
}

uint32_t JsonValue::unsigned_integer() const
{
  if (!value_->is_number_unsigned() || value_->get<uint64_t>() > 0xffffffffu)
    fail(fmt::format("is {}; an integer from 0 to 4294967295 is needed", shown(*value_)));
  return value_->get<uint32_t>();
}

std::string JsonValue::text() const
{
  if (!value_->is_string()) fail(fmt::format("is {}; a string is needed", shown(*value_)));
  return value_->get<std::string>();
}

size_t JsonValue::choice(std::span<const char *const> names) const
{
  if (value_->is_string())
    for (size_t i = 0; i < names.size(); ++i)
      if (value_->get_ref<const std::string &>() == names[i]) return i;
  fail(fmt::format("is {}; one of {} is needed", shown(*value_), joined(names)));
}

nlohmann::json parse_json(const std::string &text, const std::string &where)
{
  try {
    return nlohmann::json::parse(text, StrictParsing(where));
  } catch (const nlohmann::json::parse_error &error) {
    throw InputError(
        fmt::format("{}:{}: malformed JSON: {}", where, line_and_column(text, error.byte), plain_reason(error.what())));
  } catch (const nlohmann::json::exception &error) {
    throw InputError(fmt::format("{}: malformed JSON: {}", where, plain_reason(error.what())));
  }
}

} // namespace tandem
