/* Builds of programs: compiler logs, the cache of binaries, and faults in the cache. */
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include "host/runtime/opencl/program.h"
#include "host/runtime/opencl/program_cache.h"
#include "tests/host/runtime/opencl/opencl_device.h"

using namespace tandem;
namespace files = std::filesystem;

namespace {

/* A cache of the test's own, removed at its end. */
struct PrivateCache {
  files::path directory = files::temp_directory_path() / ("tandem-cache-test-" + std::to_string(getpid()));
  Environment environment{"TANDEM_CACHE_DIR", directory.string()};
  ~PrivateCache() { files::remove_all(directory); }
};

std::string content_of(const files::path &file)
{
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const files::path &file, const std::string &content) { std::ofstream(file, std::ios::binary) << content; }

size_t files_in(const files::path &directory)
{
  return static_cast<size_t>(std::distance(files::directory_iterator(directory), files::directory_iterator()));
}

const opencl::Binary some_bytes = {1, 2, 3, 0, 255};

} // namespace

TEST_CASE("the kernel cache gives back what was stored, under its own key only")
{
  const PrivateCache cache;
  REQUIRE(!opencl::load_binary("key"));
  opencl::store_binary("key", some_bytes);
  REQUIRE(opencl::load_binary("key") == some_bytes);
  REQUIRE(!opencl::load_binary("another key"));
  REQUIRE(files_in(cache.directory) == 1);
}

TEST_CASE("a truncated, corrupt or foreign file of the kernel cache is not used, and is replaced")
{
  const PrivateCache cache;
  opencl::store_binary("key", some_bytes);
  const files::path file = opencl::cache_file("key");
  const std::string whole = content_of(file);
  for (const size_t bytes : {size_t{0}, size_t{5}, size_t{12}, size_t{30}, whole.size() - 6, whole.size() - 1}) {
    write(file, whole.substr(0, bytes));
    REQUIRE(!opencl::load_binary("key"));
  }
  for (const size_t at : {size_t{0}, size_t{13}, size_t{21}, size_t{29}, whole.size() - 6, whole.size() - 1}) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    write(file, damaged);
    REQUIRE(!opencl::load_binary("key"));
  }
  write(file, whole + "x");
  REQUIRE(!opencl::load_binary("key"));
  opencl::store_binary("other", some_bytes);
  files::copy_file(opencl::cache_file("other"), file, files::copy_options::overwrite_existing);
  REQUIRE(!opencl::load_binary("key"));
  opencl::store_binary("key", some_bytes);
  REQUIRE(opencl::load_binary("key") == some_bytes);
}

TEST_CASE("a cache directory that cannot be written fails nothing")
{
  const PrivateCache cache;
  write(cache.directory, "a file where the directory should be");
  opencl::store_binary("key", some_bytes);
  REQUIRE(!opencl::load_binary("key"));
}

TEST_CASE("programs come back from the cache, and from source when the cache is damaged")
{
  const opencl::Candidate &device = test_device();
  const PrivateCache cache;
  const opencl::DeviceContext context(device);
  const EmbeddedProgram &embedded = opencl::embedded_program("parallel");
  const auto has_fill = [&](const cl::Program &program) { return cl::Kernel(program, "fill")() != nullptr; };
  REQUIRE(has_fill(opencl::build_through_cache(context, embedded)));
  const files::path file = opencl::cache_file(opencl::cache_key(context, embedded, ""));
  REQUIRE(files::exists(file));
  const auto first_written = files::last_write_time(file);
  REQUIRE(has_fill(opencl::build_through_cache(context, embedded)));
  REQUIRE(files::last_write_time(file) == first_written);

  write(file, content_of(file).substr(0, 100));
  REQUIRE(has_fill(opencl::build_through_cache(context, embedded)));
  REQUIRE(files::file_size(file) > 100);

  if (device.info.platform_name != "rusticl") { /* which ends the program when a binary is not its own */
    opencl::store_binary(opencl::cache_key(context, embedded, ""), some_bytes);
    REQUIRE(has_fill(opencl::build_through_cache(context, embedded)));
    REQUIRE(files::file_size(file) > opencl::source_of(embedded).size() + 1000);
  }
}

TEST_CASE("other options, another program: another place in the cache")
{
  const opencl::Candidate &device = test_device();
  const opencl::DeviceContext context(device);
  const EmbeddedProgram changed{"parallel", {"__kernel void fill() {}"}, {}};
  const std::string plain = opencl::cache_key(context, opencl::embedded_program("parallel"), "");
  REQUIRE(plain != opencl::cache_key(context, opencl::embedded_program("parallel"), "-D FEATURES=1"));
  REQUIRE(plain != opencl::cache_key(context, changed, ""));
}

TEST_CASE("a program that does not compile is shown with file and line")
{
  const opencl::Candidate &device = test_device();
  const PrivateCache cache;
  const opencl::DeviceContext context(device);
  const EmbeddedProgram broken{
      "broken", {"#line 1 \"cl/broken.cl\"\n\n#line 41 \"shared/math.h\"\n\nfloat f(float x) { return y; }\n"}, {}};
  try {
    opencl::build_program(context, broken);
    FAIL("it compiled");
  } catch (const opencl::BuildError &error) {
    const std::string message = error.what();
    INFO(message);
    REQUIRE(message.find("cl/broken.cl") != std::string::npos);
    if (device.info.platform_name != "Oclgrind") /* which counts lines from the start of the whole text */
      REQUIRE(message.find("shared/math.h:42") != std::string::npos);
    REQUIRE(message.find("'y'") != std::string::npos);
  }
  REQUIRE((!files::exists(cache.directory) || files_in(cache.directory) == 0));
}
