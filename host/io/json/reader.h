/* reader.h - JSON values that know where they stand, so that every complaint names its place.
 *
 * Both scene readers (our own format and the glTF extensions) take values through JsonValue: wrong
 * types, unknown keys and numbers that no float holds become one line such as
 *   pile.json: bodies[3]: unknown key "mas"; known keys: name, motion, ...
 * Not a public header.
 */
#pragma once

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include <tandem/scene.h>

namespace tandem {

/* Whether a string may stand for a number: in our own scenes, which write hexadecimal floats so. */
enum class JsonFloats { numbers_and_hexadecimal, numbers };

class JsonValue {
public:
  /* `where` (a file, perhaps a node in it) begins every message; it and `value` must outlive this. */
  JsonValue(const nlohmann::json &value, const std::string &where, std::string path = "",
            JsonFloats floats = JsonFloats::numbers_and_hexadecimal)
      : value_(&value), where_(&where), path_(std::move(path)), floats_(floats)
  {}

  [[noreturn]] void fail(const std::string &message) const;
  const std::string &where() const { return *where_; }
  const std::string &path() const { return path_; }
  bool is_null() const { return value_->is_null(); }
  std::string place() const { return path_.empty() ? *where_ : *where_ + ": " + path_; }

  /* An object's member; `find` gives nothing when it is absent, `member` fails. Both fail on non-objects. */
  std::optional<JsonValue> find(const char *key) const;
  JsonValue member(const char *key) const;
  /* Fails on the first key that is not listed. "extras" is for glTF to list. */
  void only_keys(std::span<const char *const> known) const;

  size_t array_size() const; /* fails when it is not an array */
  JsonValue element(size_t index) const;

  /* Finite floats: a number, or (JsonFloats) a string with a hexadecimal float such as "-0x1.8p+1". Fails for one that
   * is not 0 but would be rounded to it, since 0 may stand for something else, as for a mass without end. */
  float number() const;
  float coordinate()
      const; /* the same of places, directions and speeds, among which 0 is one as any other: it may be rounded to */
  double precise_number() const; /* the same, of 64 bits */
  Vec3 vec3() const;             /* of coordinates */
  Vec3 magnitudes() const;       /* of numbers, such as moments and factors of a scale */
  Point point() const;
  Quat quat() const;
  bool boolean() const;
  uint32_t unsigned_integer() const;
  std::string text() const;
  size_t choice(std::span<const char *const> names) const; /* index of the string in names */

private:
  template <class Real> Real number_of() const;

  const nlohmann::json *value_;
  const std::string *where_;
  std::string path_;
  JsonFloats floats_;
};

/* Deeper than any scene; far from where recursion over values (their text, their end) runs out of stack. */
inline constexpr int most_json_levels = 100;

/* A whole file's value, which ends without allocating. The destructor of nlohmann's values makes a list of what they
 * hold, and ends the process where there is no memory for it; here they are taken apart from the leaves on, so that it
 * finds nothing to list. */
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

/* Throws InputError: `where:line:column: malformed JSON: …`, a key that stands twice in one object, or more than
 * most_json_levels arrays and objects within one another. */
JsonDocument parse_json(const std::string &text, const std::string &where);

} // namespace tandem
