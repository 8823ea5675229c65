/* banned_operations - finds operations that do not give the same bits on every backend.
 *
 * Exactness rests on the few operations that every device rounds alike (docs/exactness.md). One fused multiply-add or
 * one built-in sine would pass every test on the machine of its author and differ on the next, so this check reads the
 * sources.
 *
 *   shared/ cl/ minicl/            calls of banned functions, float atomics, fused and approximate intrinsics
 *   host/                          functions of the C library whose last bit differs between machines, where results
 *                                  depend on it, and roundings to float that a compiler may leave out
 *   these, tools/, tests/, CMake   compiler and OpenCL options that relax arithmetic, also within strings
 *
 * Usage: banned_operations ROOT              lists file:line: operation; exit status 1 if there is any
 *        banned_operations --self-test DIR   plants each operation in a tree under DIR and must find every one
 */
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Hit {
  std::string file;
  int line;
  std::string operation;
  bool operator==(const Hit &) const = default;
};

/* Functions that are not correctly rounded everywhere, or that treat NaN, signed zero or denormals differently. */
const std::vector<std::string> banned_functions = {
    "fma",    "mad",    "mad24",  "mad_hi",    "mul24",     "mul_hi",      "select",        "bitselect",
    "fmin",   "fmax",   "min",    "max",       "rint",      "round",       "trunc",         "ceil",
    "minmag", "maxmag", "clamp",  "mix",       "step",      "smoothstep",  "degrees",       "radians",
    "dot",    "cross",  "length", "distance",  "normalize", "fast_length", "fast_distance", "fast_normalize",
    "sin",    "cos",    "tan",    "sincos",    "sinpi",     "cospi",       "tanpi",         "asin",
    "acos",   "atan",   "atan2",  "asinpi",    "acospi",    "atanpi",      "atan2pi",       "sinh",
    "cosh",   "tanh",   "asinh",  "acosh",     "atanh",     "exp",         "exp2",          "exp10",
    "expm1",  "log",    "log2",   "log10",     "log1p",     "logb",        "ilogb",         "pow",
    "pown",   "powr",   "rootn",  "sqrt",      "cbrt",      "hypot",       "rsqrt",         "erf",
    "erfc",   "tgamma", "lgamma", "lgamma_r",  "ldexp",     "scalbn",      "scalbln",       "frexp",
    "modf",   "fract",  "fmod",   "remainder", "remquo",    "fdim",        "nextafter",     "nearbyint",
    "lrint",  "llrint", "lround", "llround"};

/* Of the C library's mathematics IEEE 754 fixes only what rounds exactly or not at all (sqrt, floor, frexp, ldexp,
 * nextafter). */
const std::vector<std::string> inexact_functions = {
    "sin",  "cos",   "tan",  "sincos", "asin",   "acos",   "atan",  "atan2", "sinh",  "cosh",
    "tanh", "exp",   "exp2", "exp10",  "expm1",  "log",    "log2",  "log10", "log1p", "pow",
    "cbrt", "hypot", "erf",  "erfc",   "tgamma", "lgamma", "asinh", "acosh", "atanh"};

/* They measure or draw what was simulated, and nothing is simulated with what they find. */
const std::vector<std::string> measuring_files = {"host/verify/metrics.cpp", "host/verify/joint_error.cpp",
                                                  "host/verify/coupling_error.cpp", "host/io/glb/geometry.cpp"};

/* Families: any width, rounding mode or address space of them. */
const std::vector<std::string> banned_families = {
    /* precision left to the device */
    "native_[a-z0-9]+", "half_(cos|divide|exp|exp2|exp10|log|log2|log10|powr|recip|rsqrt|sin|sqrt|tan)",
    /* saturating casts of NaN differ */
    "convert_[a-z0-9]+_sat[a-z_]*",
    /* order decides the sum */
    "(atomic|atom|ATOMIC)_?[A-Za-z_]*(float|double|real|fp32|fp64|FLOAT|REAL)[A-Za-z0-9_]*",
    "(cl_ext_float_atomics|__opencl_c_ext_fp[0-9]+_[a-z_]+)",
    /* fused or approximate */
    "_mm(256|512)?_(mask_|maskz_)?(fn?m(add|sub|addsub|subadd)|rsqrt[0-9]*|rcp[0-9]*)_[a-z]+"};

/* Options that let a compiler change roundings; hits also within strings, where options live. */
const std::vector<std::string> banned_options = {"-cl-fast-relaxed-math",
                                                 "-cl-unsafe-math-optimizations",
                                                 "-cl-finite-math-only",
                                                 "-cl-mad-enable",
                                                 "-cl-no-signed-zeros",
                                                 "-cl-denorms-are-zero",
                                                 "-cl-single-precision-constant",
                                                 "-ffast-math",
                                                 "-Ofast",
                                                 "-funsafe-math-optimizations",
                                                 "-fassociative-math",
                                                 "-freciprocal-math",
                                                 "-ffinite-math-only",
                                                 "-ffp-contract=fast",
                                                 "-ffp-contract=on",
                                                 "-fno-signed-zeros",
                                                 "-mrecip",
                                                 "FP_CONTRACT ON"};

/* platform.h gives the correctly rounded square root its name, minicl/ gives it to lanes; the dispatcher counts
 * items. */
bool allowed(const std::string &file, const std::string &function)
{
  const auto any_of = [&](std::initializer_list<const char *> names) {
    return std::any_of(names.begin(), names.end(), [&](const char *name) { return function == name; });
  };
  const bool dispatcher = file.starts_with("minicl/");
  return ((dispatcher || file == "shared/platform.h") && any_of({"sqrt", "__builtin_sqrt", "__builtin_sqrtf"})) ||
         (dispatcher && any_of({"min", "max", "clamp", "distance", "step"}));
}

enum class Comments { c_style, hash };

/* The text with comments, and on demand the inside of literals, replaced by blanks; line breaks stay. */
std::string blanked(const std::string &text, Comments comments, bool blank_literals)
{
  std::string out = text;
  const auto blank = [&](size_t from, size_t to) {
    for (size_t i = from; i < std::min(to, out.size()); ++i) {
      if (out[i] != '\n') out[i] = ' ';
    }
  };
  const auto end_of = [&](const std::string &mark, size_t from) {
    const size_t at = text.find(mark, from);
    return at == std::string::npos ? text.size() : at + mark.size();
  };
  for (size_t i = 0; i < text.size();) {
    size_t end = i + 1;
    const bool digit_separator = text[i] == '\'' && i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1]));
    if (comments == Comments::c_style && text.compare(i, 2, "/*") == 0) {
      blank(i, end = end_of("*/", i + 2));
    } else if ((comments == Comments::c_style && text.compare(i, 2, "//") == 0) ||
               (comments == Comments::hash && text[i] == '#')) {
      blank(i, end = end_of("\n", i));
    } else if (text[i] == '"' || (comments == Comments::c_style && text[i] == '\'' && !digit_separator)) {
      while (end < text.size() && text[end] != text[i] && text[end] != '\n') end += text[end] == '\\' ? 2 : 1;
      if (blank_literals) blank(i + 1, end);
      ++end;
    }
    i = end;
  }
  return out;
}

int line_of(const std::string &text, size_t at)
{
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/* fma, fmaf and __builtin_fmaf are one function. */
bool is_one_of(const std::vector<std::string> &functions, std::string name)
{
  const std::string builtin = "__builtin_";
  if (name.compare(0, builtin.size(), builtin) == 0) name.erase(0, builtin.size());
  const auto listed = [&](const std::string &n) {
    return std::find(functions.begin(), functions.end(), n) != functions.end();
  };
  const bool suffixed = name.size() > 1 && (name.back() == 'f' || name.back() == 'l');
  return listed(name) || (suffixed && listed(name.substr(0, name.size() - 1)));
}

bool is_banned_family(const std::string &name)
{
  static const std::vector<std::regex> families = [] {
    std::vector<std::regex> all;
    for (const std::string &family : banned_families) all.emplace_back(family);
    return all;
  }();
  return std::any_of(families.begin(), families.end(), [&](const std::regex &f) { return std::regex_match(name, f); });
}

/* Every name in the code for which is_hit(name, whether it is called). */
template <class IsHit>
void find_names(const std::string &file, const std::string &text, std::vector<Hit> &hits, const IsHit &is_hit)
{
  const std::string code = blanked(text, Comments::c_style, true);
  static const std::regex identifier("[A-Za-z_][A-Za-z0-9_]*");
  for (std::sregex_iterator word(code.begin(), code.end(), identifier), none; word != none; ++word) {
    const std::string name = word->str();
    const size_t after = code.find_first_not_of(" \t\n\\", static_cast<size_t>(word->position()) + name.size());
    const bool called = after != std::string::npos && code[after] == '(';
    if (is_hit(name, called)) hits.push_back({file, line_of(code, static_cast<size_t>(word->position())), name});
  }
}

void find_functions(const std::string &file, const std::string &text, std::vector<Hit> &hits)
{
  find_names(file, text, hits, [&](const std::string &name, bool called) {
    return ((called && is_one_of(banned_functions, name)) || is_banned_family(name)) && !allowed(file, name);
  });
}

/* In host/: float(x) and static_cast<float>(x) round what may be a double; of whole numbers an initialisation does
 * without. */
void find_host_functions(const std::string &file, const std::string &text, std::vector<Hit> &hits)
{
  if (std::find(measuring_files.begin(), measuring_files.end(), file) == measuring_files.end())
    find_names(file, text, hits,
               [&](const std::string &name, bool called) { return called && is_one_of(inexact_functions, name); });
  if (file == "host/include/tandem/round_to_float.h") return;
  find_names(file, text, hits, [&](const std::string &name, bool called) { return called && name == "float"; });
  const std::string code = blanked(text, Comments::c_style, true), cast = "static_cast<float>";
  for (size_t at = code.find(cast); at != std::string::npos; at = code.find(cast, at + 1))
    hits.push_back({file, line_of(code, at), cast});
}

void find_options(const std::string &file, const std::string &text, std::vector<Hit> &hits)
{
  static const std::vector<std::string> endings = {".cmake", ".cmake.in", "CMakeLists.txt", ".json", ".sh"};
  const bool hash = std::any_of(endings.begin(), endings.end(), [&](const auto &end) { return file.ends_with(end); });
  const std::string code = blanked(text, hash ? Comments::hash : Comments::c_style, false);
  for (const std::string &option : banned_options) {
    for (size_t at = code.find(option); at != std::string::npos; at = code.find(option, at + 1)) {
      hits.push_back({file, line_of(code, at), option});
    }
  }
}

std::string read(const fs::path &path)
{
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

bool is_source(const fs::path &path)
{
  static const std::vector<std::string> endings = {".h",     ".c",   ".cpp",  ".cl", ".def", ".inc",
                                                   ".cmake", ".txt", ".json", ".in", ".sh"};
  return std::find(endings.begin(), endings.end(), path.extension().string()) != endings.end();
}

std::vector<Hit> scan(const fs::path &root, int &files)
{
  std::vector<Hit> hits;
  const auto scan_file = [&](const fs::path &path, bool functions) {
    const std::string name = fs::relative(path, root).generic_string(), text = read(path);
    if (functions) find_functions(name, text, hits);
    if (name.starts_with("host/")) find_host_functions(name, text, hits);
    if (name != "tests/checks/banned_operations.cpp") find_options(name, text, hits);
    ++files;
  };
  for (const char *folder : {"shared", "cl", "minicl", "host", "tools", "tests", "cmake"}) {
    if (!fs::exists(root / folder)) continue;
    const bool functions =
        folder == std::string("shared") || folder == std::string("cl") || folder == std::string("minicl");
    for (const auto &entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.is_regular_file() && is_source(entry.path())) scan_file(entry.path(), functions);
    }
  }
  for (const char *file : {"CMakeLists.txt", "CMakePresets.json"}) {
    if (fs::exists(root / file)) scan_file(root / file, false);
  }
  return hits;
}

std::vector<Hit> scan_text(const fs::path &root, const std::string &file, const std::string &text)
{
  fs::remove_all(root);
  fs::create_directories((root / file).parent_path());
  std::ofstream(root / file) << text;
  int files = 0;
  return scan(root, files);
}

int failures = 0;

void expect(const std::vector<Hit> &found, const std::vector<Hit> &wanted, const std::string &what)
{
  if (found == wanted) return;
  ++failures;
  std::cerr << "self-test: " << what << ": " << found.size() << " hits instead of " << wanted.size() << '\n';
  for (const Hit &hit : found) std::cerr << "  found " << hit.file << ':' << hit.line << ' ' << hit.operation << '\n';
}

/* Every banned function in every spelling, planted in line 2 of a shared header. */
void test_functions(const fs::path &root)
{
  std::vector<std::string> names = {
      "native_sin",       "native_recip",    "half_sqrt",         "convert_int_sat", "convert_uchar4_sat_rte",
      "atomic_add_float", "ATOMIC_ADD_REAL", "atom_cmpxchg_fp32", "_mm256_fmadd_ps", "_mm512_rsqrt14_ps",
      "_mm_rcp_ss"};
  for (const std::string &name : banned_functions) {
    for (const std::string &spelling : {name, name + "f", "__builtin_" + name, "__builtin_" + name + "f"})
      names.push_back(spelling);
  }
  const std::string file = "shared/solve/planted.h";
  for (const std::string &name : names) {
    expect(scan_text(root, file, "/* here: */\nreal y = " + name + " (x);\n"), {{file, 2, name}}, name);
  }
  expect(scan_text(root, "cl/planted.cl", "#define DOT(a, b) \\\n  dot(a, b)\n"), {{"cl/planted.cl", 2, "dot"}},
         "a macro");
  expect(scan_text(root, file, "int i = 'x'; char q = '\\''; real y = max(a, \")\");"), {{file, 1, "max"}},
         "after literals");
}

void test_host_functions(const fs::path &root)
{
  const std::string file = "host/scene_planted.cpp";
  for (const std::string &name : inexact_functions)
    expect(scan_text(root, file, "\ndouble y = std::" + name + "(x);"), {{file, 2, name}}, name + " in host/");
  expect(scan_text(root, file, "return {float(x), float (y)};"), {{file, 1, "float"}, {file, 1, "float"}},
         "a functional cast");
  expect(scan_text(root, file, "p =\n static_cast<float>(x);"), {{file, 2, "static_cast<float>"}}, "a cast");
  expect(scan_text(root, file,
                   "float y = round_to_float(x); sizeof(float); std::sqrt(x); parse<float>(text); // float(x), sin(x)"),
         {}, "harmless host code");
  expect(scan_text(root, "host/verify/metrics.cpp", "double y = std::pow(x, 2);"), {}, "a measurement");
  expect(scan_text(root, "tools/planted.cpp", "double y = std::pow(x, 2), z = float(x);"), {}, "tools");
}

void test_options(const fs::path &root)
{
  for (const std::string &option : banned_options) {
    expect(scan_text(root, "host/planted.cpp", "\nauto flags = \"-I. " + option + "\";"),
           {{"host/planted.cpp", 2, option}}, option);
    for (const std::string file : {"CMakeLists.txt", "cmake/module/planted.cmake.in", "tests/docs/planted.sh"})
      expect(scan_text(root, file, "add_compile_options(" + option + ")"), {{file, 1, option}}, option);
  }
}

void test_harmless(const fs::path &root)
{
  const std::string harmless =
      "minimum(a, b); maximum(a, b); length_of(v); length_squared(v); clamped(x, a, b); dot3(a, b); cross3(a, b);\n"
      "square_root(x); quat_normalized(q); sine(x); cosine(x); arc_tangent2(y, x); real mix = dot + max; mask half; "
      "half_extents(s);\n"
      "ATOMIC_ADD(p, 1u); atomic_add_uint(p, 1u); ATOMIC_MAX(p, v); atomic_max_uint(p, v); to_real(x); summing(x);\n"
      "/* fma(a, b, c), sin(x)\n   mad(a, b, c) */ // dot(a, b)\n\"fmin(a, b) /* \"; /* native_sin(x) */ 'm';\n";
  expect(scan_text(root, "shared/harmless.h", harmless), {}, "harmless words, comments and strings");
  expect(scan_text(root, "shared/platform.h", "#define SQUARE_ROOT(x) __builtin_sqrtf(x)\n"), {},
         "the square root of platform.h");
  expect(scan_text(root, "minicl/dispatcher.cpp", "std::max(a, b)\n__builtin_fmaf(a, b, c)"),
         {{"minicl/dispatcher.cpp", 2, "__builtin_fmaf"}}, "the dispatcher");
  expect(scan_text(root, "shared/real.h", "#define SQUARE_ROOT(x) sqrt(x)\n"), {{"shared/real.h", 1, "sqrt"}},
         "a square root elsewhere");
  expect(scan_text(root, "host/harmless.cpp", "std::max(a, b); // -cl-denorms-are-zero\n"), {}, "host code");
  expect(scan_text(root, "CMakeLists.txt", "add_compile_options(-ffp-contract=off -fno-fast-math) # not -ffast-math\n"),
         {}, "CMake");
}

int self_test(const fs::path &root)
{
  test_functions(root);
  test_host_functions(root);
  test_options(root);
  test_harmless(root);
  fs::remove_all(root);
  std::cout << "self-test: " << (failures ? "failed" : "every banned operation is found, harmless words are not")
            << '\n';
  return failures != 0;
}

int check(const fs::path &root)
{
  int files = 0;
  const std::vector<Hit> hits = scan(root, files);
  for (const Hit &hit : hits) {
    std::cout << hit.file << ':' << hit.line << ": " << hit.operation
              << " does not give the same bits everywhere (docs/exactness.md)\n";
  }
  if (files == 0) throw std::runtime_error("no source under " + root.string());
  std::cout << files << " files read, " << hits.size() << " banned operations\n";
  return !hits.empty();
}

} // namespace

int main(int count, char **arguments)
try {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.size() == 2 && given[0] == "--self-test")
    return self_test(fs::path(given[1]) / "banned-operations-self-test");
  if (given.size() == 1) return check(given[0]);
  throw std::runtime_error("usage: banned_operations ROOT | --self-test DIR");
} catch (const std::exception &error) {
  std::cerr << "banned_operations: " << error.what() << '\n';
  return 2;
}
