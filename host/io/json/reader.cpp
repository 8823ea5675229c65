/* reader.cpp - parses JSON with limits on depth and duplicate keys, and converts values; see reader.h. */
#include "host/io/json/reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

namespace tandem {
namespace {

std::string joined(std::span<const char *const> names)
{
  std::string text;
  for (const char *name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

/* The value as it is in the file, shortened, for messages. */
std::string shown(const nlohmann::json &value)
{
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

/* std::from_chars accepts hexadecimal digits only without the 0x that strtof and printf("%a") use. */
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

std::string line_and_column(const std::string &text, size_t byte)
{
  size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
  size_t line = 1 + size_t(std::count(text.begin(), text.begin() + ptrdiff_t(end), '\n'));
  size_t start = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
  return fmt::format("{}:{}", line, start == std::string::npos ? end + 1 : end - start);
}

/* The library's message without its prefix and position. */
std::string plain_reason(const std::string &what)
{
  size_t column = what.find("column ");
  size_t colon = column == std::string::npos ? std::string::npos : what.find(": ", column);
  if (colon != std::string::npos) return what.substr(colon + 2);
  size_t bracket = what.find("] ");
  return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

/* A number too small for a double becomes the smallest one, so that it differs from 0 later. */
double zero_or_least(const std::string &text)
{
  const std::string digits = text.substr(0, text.find_first_of("eE"));
  if (digits.find_first_of("123456789") == std::string::npos) return text.starts_with("-") ? -0.0 : 0.0;
  const double least = std::numeric_limits<double>::denorm_min();
  return text.starts_with("-") ? -least : least;
}

/* Builds a document during parsing, so that a document that an exception leaves incomplete is a JsonDocument too.
 * Duplicate keys would silently lose a value, and unlimited depth would overflow the stack. */
class Builder : public nlohmann::json_sax<nlohmann::json> {
public:
  Builder(const std::string &text, const std::string &where) : text_(text), where_(where) {}

  JsonDocument document;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t &text) override
  {
    return add(value == 0 ? zero_or_least(text) : value);
  }
  bool string(string_t &value) override { return add(std::move(value)); }
  bool binary(binary_t &) override { return false; } /* JSON as text has none */
  bool start_object(size_t) override { return open(nlohmann::json::object()); }
  bool start_array(size_t) override { return open(nlohmann::json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t &key) override;
  bool parse_error(size_t, const std::string &, const nlohmann::json::exception &error) override;

private:
  nlohmann::json &place(nlohmann::json &&value);
  bool add(nlohmann::json value)
  {
    place(std::move(value));
    return true;
  }
  bool open(nlohmann::json &&empty);
  bool close()
  {
    open_.pop_back();
    return true;
  }

  const std::string &text_, &where_;
  std::vector<nlohmann::json *> open_; /* arrays and objects that have not ended, the innermost last */
  nlohmann::json *member_ = nullptr;   /* the value that the last key names */
};

nlohmann::json &Builder::place(nlohmann::json &&value)
{
  if (!open_.empty() && open_.back()->is_array()) {
    open_.back()->get_ref<nlohmann::json::array_t &>().push_back(std::move(value));
    return open_.back()->back();
  }
  nlohmann::json &at = open_.empty() ? document.value() : *member_;
  at.swap(value);
  return at;
}

bool Builder::open(nlohmann::json &&empty)
{
  if (open_.size() >= most_json_levels)
    throw InputError(
        fmt::format("{}: arrays and objects stand more than {} deep within one another; no scene needs that", where_,
                    most_json_levels));
  open_.push_back(&place(std::move(empty)));
  return true;
}

bool Builder::key(string_t &key)
{
  const auto [member, is_new] = open_.back()->get_ref<nlohmann::json::object_t &>().try_emplace(key, nullptr);
  if (!is_new)
    throw InputError(fmt::format("{}: the key {} stands twice in one object", where_, nlohmann::json(key).dump()));
  member_ = &member->second;
  return true;
}

bool Builder::parse_error(size_t position, const std::string &, const nlohmann::json::exception &error)
{
  const auto *place = dynamic_cast<const nlohmann::json::parse_error *>(&error);
  const std::string where = line_and_column(text_, place ? place->byte : position);
  throw InputError(fmt::format("{}:{}: malformed JSON: {}", where_, where, plain_reason(error.what())));
}

/* The number of levels is limited (most_json_levels), so recursion is safe. */
void take_apart(nlohmann::json &value)
{
  for (nlohmann::json &part : value)
    if (part.is_structured()) take_apart(part);
  if (value.is_structured()) value.clear();
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
  if (!std::isfinite(round_to_float(result)))
    fail(fmt::format("is {}; no finite 32-bit float holds that", shown(*value_)));
  return Real(result);
}

float JsonValue::number() const
{
  const float rounded = coordinate();
  if (rounded == 0 && value_->is_number() && value_->get<double>() != 0)
    fail(fmt::format("is {}, which a 32-bit float rounds to 0; 0 itself or a larger number is needed", shown(*value_)));
  return rounded;
}

float JsonValue::coordinate() const { return number_of<float>(); }
double JsonValue::precise_number() const { return number_of<double>(); }

Vec3 JsonValue::vec3() const
{
  if (array_size() != 3) fail(fmt::format("is {}; an array of 3 numbers is needed", shown(*value_)));
  return {element(0).coordinate(), element(1).coordinate(), element(2).coordinate()};
}

Vec3 JsonValue::magnitudes() const
{
  vec3();
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
  return {element(0).coordinate(), element(1).coordinate(), element(2).coordinate(), element(3).coordinate()};
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

uint64_t JsonValue::long_unsigned_integer() const
{
  if (!value_->is_number_unsigned())
    fail(fmt::format("is {}; an integer from 0 to 18446744073709551615 is needed", shown(*value_)));
  return value_->get<uint64_t>();
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

JsonDocument::~JsonDocument() { take_apart(value_); }

JsonDocument parse_json(const std::string &text, const std::string &where)
{
  if (const size_t zero = text.find('\0'); zero != std::string::npos) /* the library would stop there silently */
    throw InputError(fmt::format("{}:{}: malformed JSON: a byte of 0; it stands in no text", where,
                                 line_and_column(text, zero + 1)));
  Builder builder(text, where);
  nlohmann::json::sax_parse(text, &builder);
  return std::move(builder.document);
}

} // namespace tandem
