/* self_test.cpp - the start-up test of a device: it runs shared/parallel/self_test.h there and on the host and compares
 * the results bit for bit.
 *
 * Without correctly rounded division an H200 differs in 28% of quotients and 17% of square roots, and with contraction
 * in 30% of a * b + c, so a few thousand inputs leave no doubt. A driver that promises less than it does is tested
 * with more of them. NaNs compare equal, because their payloads differ between devices and never enter the state.
 */
#include "shared/parallel/self_test.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/round_to_float.h>

#include "host/runtime/interface/floating_point.h"
#include "host/runtime/opencl/context.h"
#include "host/runtime/opencl/program.h"
#include "shared/counts.h"

namespace tandem::opencl {
namespace {

constexpr const char *real_names[] = {
#define NAME_OF(name, expression) name,
    SELF_TEST_REALS(NAME_OF)};
constexpr const char *word_names[] = {SELF_TEST_WORDS(NAME_OF)};
#undef NAME_OF

struct Inputs {
  std::vector<float> numbers;
  std::vector<uint32_t> words;
};

struct Results {
  std::vector<float> reals;
  std::vector<uint32_t> words, totals, phases;
};

/* SplitMix64, so that the inputs are the same on every machine. */
uint64_t next_random(uint64_t &state)
{
  uint64_t z = state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

float from_bits(uint32_t bits) { return std::bit_cast<float>(bits); }

/* Zeros, units, limits of the format, neighbours of powers of two, infinity and NaN. */
constexpr std::array<uint32_t, 24> edges = {0x00000000, 0x80000000, 0x3f800000, 0xbf800000, 0x00000001, 0x80000001,
                                            0x007fffff, 0x00800000, 0x00800001, 0x80800000, 0x7f7fffff, 0xff7fffff,
                                            0x3f7fffff, 0x3f800001, 0x34000000, 0x33800000, 0x4b000000, 0x4b800000,
                                            0x4f000000, 0xcf000000, 0x40490fdb, 0x3eaaaaab, 0x7f800000, 0x7fc00000};

float random_number(uint64_t &state, uint32_t kind)
{
  const uint64_t random = next_random(state);
  const uint32_t bits = static_cast<uint32_t>(random);
  switch (kind) {
  case 0: return from_bits(edges[bits % edges.size()]);
  case 1: return from_bits(bits);               /* any bits */
  case 2: return from_bits(bits & 0x807fffffu); /* denormals */
  case 3: return from_bits(bits & 0x80ffffffu); /* denormals and the smallest normals */
  default:
    return from_bits((0x38000000u + (bits & 0x0fffffffu)) | (bits & 0x80000000u)); /* 3e-5 to 1e5, as in a scene */
  }
}

Inputs make_inputs(uint32_t count)
{
  uint64_t state = 2009;
  Inputs inputs;
  for (uint32_t i = 0; i < count; ++i) {
    float a = random_number(state, i % 8), b = random_number(state, i / 8 % 8), c = random_number(state, i / 64 % 8);
    if (i % 16 == 7)
      b = from_bits(std::bit_cast<uint32_t>(a) + static_cast<uint32_t>(next_random(state) % 5)); /* cancels */
    if (i % 16 == 15) c = -(a * b);
    inputs.numbers.insert(inputs.numbers.end(), {a, b, c});
    const uint64_t random = next_random(state);
    const uint32_t narrow = i % 4 ? 0 : 20;
    inputs.words.insert(inputs.words.end(),
                        {static_cast<uint32_t>(random) >> narrow, static_cast<uint32_t>(random >> 32)});
  }
  return inputs;
}

Results empty_results(uint32_t count)
{
  return {std::vector<float>(count * SELF_TEST_REAL_COUNT),
          std::vector<uint32_t>(count * SELF_TEST_WORD_COUNT),
          {0, 0, 0xffffffffu, 0},
          std::vector<uint32_t>(count)};
}

Results run_here(Inputs inputs, uint32_t count)
{
  Results results = empty_results(count);
  for (uint32_t i = 0; i < count; ++i)
    self_test_item(inputs.numbers.data(), inputs.words.data(), results.reals.data(), results.words.data(),
                   results.totals.data(), i);
  std::vector<uint32_t> memory(2 * TILE);
  for (uint32_t group = 0; group < count / TILE; ++group)
    self_test_group(inputs.words.data(), results.phases.data(), memory.data(), group);
  return results;
}

template <class T> cl::Buffer buffer_of(const DeviceContext &context, std::vector<T> &values)
{
  fail_where_a_test_wants(faults::Site::allocation, "clCreateBuffer");
  return cl::Buffer(context.context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, values.size() * sizeof(T),
                    values.data());
}

template <class T> void read_back(const DeviceContext &context, const cl::Buffer &buffer, std::vector<T> &values)
{
  fail_where_a_test_wants(faults::Site::transfer, "clEnqueueReadBuffer");
  context.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
}

template <class... Arguments>
void launch(const DeviceContext &context, const cl::Program &program, const char *name, size_t groups,
            const Arguments &...arguments)
{
  cl::Kernel kernel(program, name);
  cl_uint index = 0;
  (kernel.setArg(index++, arguments), ...);
  const size_t group = std::min<size_t>(64, kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(context.device));
  fail_where_a_test_wants(faults::Site::launch, "clEnqueueNDRangeKernel");
  context.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(groups * group), cl::NDRange(group));
}

Results run_there(const DeviceContext &context, Inputs inputs, uint32_t count, const EmbeddedProgram &embedded)
{
  const cl::Program program = build_program(context, embedded);
  Results results = empty_results(count);
  std::vector<uint32_t> range = {0, count};
  const cl::Buffer counts = buffer_of(context, range), numbers = buffer_of(context, inputs.numbers);
  const cl::Buffer words = buffer_of(context, inputs.words), reals = buffer_of(context, results.reals);
  const cl::Buffer word_results = buffer_of(context, results.words), totals = buffer_of(context, results.totals);
  const cl::Buffer phases = buffer_of(context, results.phases);
  launch(context, program, "self_test", count / 64, numbers, words, reals, word_results, totals, counts, cl_uint{0},
         cl_uint{1});
  launch(context, program, "self_test_phases", count / TILE, words, phases, counts, cl_uint{0}, cl_uint{1});
  read_back(context, reals, results.reals);
  read_back(context, word_results, results.words);
  read_back(context, totals, results.totals);
  read_back(context, phases, results.phases);
  return results;
}

bool same(float a, float b)
{
  return (std::isnan(a) && std::isnan(b)) || std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b);
}

std::string described(const std::map<std::string, uint32_t> &wrong, uint32_t count, const char *truth)
{
  std::vector<std::string> parts;
  for (const auto &[name, times] : wrong) parts.push_back(fmt::format("{} ({} times)", name, times));
  return parts.empty() ? ""
                       : fmt::format("over {} inputs it differs from {} in {}", count, truth, fmt::join(parts, ", "));
}

std::string difference(const Results &here, const Results &there, uint32_t count)
{
  std::map<std::string, uint32_t> wrong;
  for (size_t i = 0; i < here.reals.size(); ++i)
    if (!same(here.reals[i], there.reals[i])) ++wrong[real_names[i % SELF_TEST_REAL_COUNT]];
  for (size_t i = 0; i < here.words.size(); ++i)
    if (here.words[i] != there.words[i]) ++wrong[word_names[i % SELF_TEST_WORD_COUNT]];
  if (here.totals != there.totals) wrong["integer atomics"] = 1;
  if (here.phases != there.phases) wrong["local memory and barriers"] = 1;
  return described(wrong, count, "the host");
}

uint32_t input_count(const Candidate &candidate)
{
  if (candidate.info.platform_name == "Oclgrind") return TILE; /* a simulator, a thousand times slower */
  return candidate.lacks.empty() ? 8 * TILE : 64 * TILE;
}

/* A compiler's log as one line, for the message of a refusal. */
std::string one_line(std::string text)
{
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) text.replace(at, 1, "; ");
  return text;
}

/* The verdict is not final if the device could not be queried, because a later query may succeed. */
struct Verdict {
  std::string difference;
  bool is_final;
};

Verdict tested(Candidate &candidate)
{
  try {
    const DeviceContext context(candidate);
    candidate.context = context.context;
    return {self_test(context, input_count(candidate), embedded_program("self_test")), true};
  } catch (const cl::Error &error) {
    return {fmt::format("{} failed with {}", error.what(), error_name(error.err())), false};
  } catch (const std::exception &error) {
    return {one_line(error.what()), false};
  }
}

/* Double has more than twice float's digits, so a double result rounded to float is the correctly rounded one, unless
 * that is denormal (for sums and products, always). */
struct RightAnswer {
  const char *name;
  float value;
  bool known = true;
};

std::array<RightAnswer, 6> right_answers(float a, float b, float c)
{
  const double x = a, y = b;
  const float product = round_to_float(x * y), quotient = round_to_float(x / y);
  return {{{"addition", round_to_float(x + y)},
           {"subtraction", round_to_float(x - y)},
           {"multiplication", product},
           {"division", quotient, std::abs(quotient) > std::numeric_limits<float>::min()},
           {"square root", round_to_float(std::sqrt(x))},
           {"contraction of a * b + c", round_to_float(static_cast<double>(product) + c)}}};
}

size_t column_of(const std::string &name)
{
  return static_cast<size_t>(std::find(std::begin(real_names), std::end(real_names), name) - std::begin(real_names));
}

} // namespace

std::string host_self_test()
{
  const minicl::ExactFloatingPoint environment;
  constexpr uint32_t count = 8 * TILE;
  const Inputs inputs = make_inputs(count);
  const Results here = run_here(inputs, count);
  std::map<std::string, uint32_t> wrong;
  for (uint32_t i = 0; i < count; ++i)
    for (const RightAnswer &right :
         right_answers(inputs.numbers[3 * i], inputs.numbers[3 * i + 1], inputs.numbers[3 * i + 2]))
      if (right.known && !same(here.reals[i * SELF_TEST_REAL_COUNT + column_of(right.name)], right.value))
        ++wrong[right.name];
  return described(wrong, count, "IEEE 754");
}

std::string self_test(const DeviceContext &context, uint32_t count, const EmbeddedProgram &program)
{
  const minicl::ExactFloatingPoint environment;
  const Inputs inputs = make_inputs(count);
  return difference(run_here(inputs, count), run_there(context, inputs, count, program), count);
}

std::string self_test(Candidate &candidate)
{
  static std::mutex mutex;
  static std::map<cl_device_id, std::string> verdicts;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto known = verdicts.find(candidate.device());
  if (known != verdicts.end()) return known->second;
  const Verdict verdict = tested(candidate);
  if (verdict.is_final) verdicts[candidate.device()] = verdict.difference;
  return verdict.difference;
}

} // namespace tandem::opencl
