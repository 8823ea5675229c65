/* json_reader.h - JSON values that know where they stand, so that every complaint names its place.
 *
 * Both scene readers (our own format and the glTF extensions) take values through JsonValue: wrong
 * types, unknown keys and numbers that no float holds become one line such as
 *   pile.json: bodies[3]: unknown key "mas"; known keys: name, motion, ...
 * Not a public header.
 */
#pragma once

#include "host/scene.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

namespace tandem {

class JsonValue {
public:
  /* `where` (a file, perhaps a node in it) begins every message; it and `value` must outlive this. */
  JsonValue(const nlohmann::json &value, const std::string &where, std::string path = "")
      : value_(&value), where_(&where), path_(std::move(path))
  {}

  [[noreturn]] void fail(const std::string &message) const;
  const std::string &where() const { return *where_; }
  std::string place() const { return path_.empty() ? *where_ : *where_ + ": " + path_; }

  /* An object's member; `find` gives nothing when it is absent, `member` fails. Both fail on non-objects. */
  std::optional<JsonValue> find(const char *key) const;
  JsonValue member(const char *key) const;
  /* Fails on the first key that is not listed. "extras" is for glTF to list. */
  void only_keys(std::span<const char *const> known) const;

  size_t array_size() const; /* fails when it is not an array */
  JsonValue element(size_t index) const;

  /* Finite floats: a number, or a string with a hexadecimal float such as "-0x1.8p+1". */
  float number() const;
  double precise_number() const; /* the same, of 64 bits */
  Vec3 vec3() const;
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
};

/* The whole file; InputError when it cannot be read. */
std::string read_file(const std::string &path);

/* Throws InputError: `where:line:column: malformed JSON: …`, or a key that stands twice in one object. */
nlohmann::json parse_json(const std::string &text, const std::string &where);

} // namespace tandem
