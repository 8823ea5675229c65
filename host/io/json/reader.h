/* reader.h - JSON values with their place in the file, so that every error message names it.
 *
 * Both scene readers (Tandem's own format and the glTF extensions) read values through JsonValue: wrong types, unknown
 * keys and numbers that no float holds become one line such as
 *   pile.json: bodies[3]: unknown key "mas"; known keys: name, motion, ...
 * This is not a public header.
 */
#pragma once

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include <tandem/scene.h>

namespace tandem {

/* Whether a string may stand for a number, as in Tandem's own scenes, which contain hexadecimal floats as strings. */
enum class JsonFloats { numbers_and_hexadecimal, numbers };

class JsonValue {
public:
  /* `where` (a file, perhaps with a node in it) begins every message; it and `value` must outlive this object. */
  JsonValue(const nlohmann::json &value, const std::string &where, std::string path = "",
            JsonFloats floats = JsonFloats::numbers_and_hexadecimal)
      : value_(&value), where_(&where), path_(std::move(path)), floats_(floats)
  {}

  [[noreturn]] void fail(const std::string &message) const;
  const std::string &where() const { return *where_; }
  const std::string &path() const { return path_; }
  bool is_null() const { return value_->is_null(); }
  std::string place() const { return path_.empty() ? *where_ : *where_ + ": " + path_; }

  /* An object's member. If it is absent, `find` returns nothing and `member` fails. Both fail for values that are not
   * objects. */
  std::optional<JsonValue> find(const char *key) const;
  JsonValue member(const char *key) const;
  /* Fails on the first key that is not listed. For glTF, "extras" must be listed too. */
  void only_keys(std::span<const char *const> known) const;

  size_t array_size() const; /* fails for values that are not arrays */
  JsonValue element(size_t index) const;

  /* A finite float: a number, or (JsonFloats) a string with a hexadecimal float such as "-0x1.8p+1". Fails for a number
   * that is not 0 but would be rounded to it, because 0 may have a special meaning, such as an infinite mass. */
  float number() const;
  float coordinate()
      const; /* the same for positions, directions and speeds, in which 0 means nothing special and may be rounded to */
  double precise_number() const; /* the same in 64 bits */
  Vec3 vec3() const;             /* of coordinates */
  Vec3 magnitudes() const;       /* of numbers, such as moments and scale factors */
  Point point() const;
  Quat quat() const;
  bool boolean() const;
  uint32_t unsigned_integer() const;
  uint64_t long_unsigned_integer() const;
  std::string text() const;
  size_t choice(std::span<const char *const> names) const; /* index of the string in names */

private:
  template <class Real> Real number_of() const;

  const nlohmann::json *value_;
  const std::string *where_;
  std::string path_;
  JsonFloats floats_;
};

/* More than the depth of any scene, and far below the depth at which recursion over values overflows the stack. */
inline constexpr int most_json_levels = 100;

/* The value of a whole file, whose destruction does not allocate. The destructor of nlohmann's values makes a list of
 * what they contain, and ends the process if there is no memory for it. Here values are taken apart from the leaves on,
 * so that there is nothing to list. */
class JsonDocument {
public:
  JsonDocument() = default;
  JsonDocument(JsonDocument &&other) noexcept { value_.swap(other.value_); }
  JsonDocument &operator=(JsonDocument &&other) noexcept
  {
    value_.swap(other.value_);
    return *this;
  }
  ~JsonDocument();

  const nlohmann::json &value() const { return value_; }
  nlohmann::json &value() { return value_; }

private:
  nlohmann::json value_;
};

/* Throws InputError `where:line:column: malformed JSON: …`, also for a duplicate key in one object and for more than
 * most_json_levels nested arrays and objects. */
JsonDocument parse_json(const std::string &text, const std::string &where);

} // namespace tandem
