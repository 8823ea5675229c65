/* opencl_device.h - the OpenCL device that tests run on; without one they are skipped. */
#pragma once

#include <algorithm>
#include <cstdlib>

#include "host/runtime/opencl/context.h"
#include "tests/catch.h"

namespace tandem {

/* The first device that passes its self-test, or null. TANDEM_TEST_DEVICE chooses by platform. */
inline const opencl::Candidate *find_test_device()
{
  static const std::vector<opencl::Candidate> candidates = opencl::find_candidates();
  const char *wanted = std::getenv("TANDEM_TEST_DEVICE");
  const auto found = std::find_if(candidates.begin(), candidates.end(), [&](opencl::Candidate candidate) {
    return (!wanted || candidate.info.platform_name == wanted) && candidate.unusable.empty() &&
           opencl::self_test(candidate).empty();
  });
  return found == candidates.end() ? nullptr : &*found;
}

inline const opencl::Candidate &test_device()
{
  const opencl::Candidate *const device = find_test_device();
  if (!device) tests::skip_device("no OpenCL device");
  return *device;
}

/* Sets an environment variable while the object lives. */
class Environment {
public:
  Environment(const char *name, const std::string &value) : name_(name)
  {
    if (const char *old = std::getenv(name)) old_ = old, had_ = true;
    setenv(name, value.c_str(), 1);
  }
  ~Environment()
  {
    if (had_) setenv(name_, old_.c_str(), 1);
    else unsetenv(name_);
  }
  Environment(const Environment &) = delete;
  Environment &operator=(const Environment &) = delete;

private:
  const char *name_;
  std::string old_;
  bool had_ = false;
};

} // namespace tandem
