/* planted.cpp - faults that the sanitizers must report, each beside a twin without the fault. CTest runs both
 * (tests/sanitizers/tests.cmake), and a fault that is not reported fails a test.
 *
 *   planted overrun BUFFER BACKEND   a step of a world in which one buffer is one element too short; `exact` instead of
 *                                    `overrun`: with the right size
 *   planted race | no-race           launches of two backends in two threads, on one buffer or on two
 */
#include <atomic>
#include <cstdio>
#include <string>
#include <thread>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "host/runtime/make_backend.h"
#include "host/runtime/memory.h"

using namespace tandem;

namespace {

/* 64 bodies: whole vectors at every width, so that none is left to the scalar kernels. */
void step_with(const std::string &name, const std::string &backend, size_t missing)
{
  Settings settings;
  settings.broadphase = Broadphase::grid; /* which has the buffers that are named */
  World world(load_scene("box-grid:nx=7,ny=3,nz=3"), settings, Placement{backend, {}, false});
  world.step(); /* which makes room for all buffers */
  const Buffer buffer = buffer_named(name);
  world.memory().resize(buffer, world.memory().bytes(buffer) - missing * size_of(row_of(buffer).element));
  world.step();
}

/* More than one thread has a share of so many items. */
constexpr uint32_t items = 4096;

class Fills {
public:
  explicit Fills(Memory &memory) : memory_(memory)
  {
    counts_[COUNT_LENGTH] = items;
    for (Buffer buffer : {Buffer::primitive_a, Buffer::primitive_b, Buffer::primitive_c})
      memory_.resize(buffer, items * sizeof(uint32_t));
  }
  /* Arguments are bound before any thread starts: the host's records of buffers are of one thread. */
  BoundArgument place(Buffer buffer) { return {memory_.acquire(buffer, host_storage(), Access::out), 0}; }
  void run(Backend &backend, BoundArgument place)
  {
    backend.run(Launch{Kernel::fill, {}, {}, COUNT_ZERO, COUNT_LENGTH, items}, {place, {nullptr, 7}}, counts_.data());
  }

private:
  Memory &memory_;
  std::array<uint32_t, COUNT_TOTAL> counts_{};
};

/* The first thread launches twice, so that an order given from launch to launch would hide its first one from the
 * second thread. That one waits for it in time alone: a relaxed flag orders nothing else. */
void launch_in_two_threads(bool on_one_buffer)
{
  Memory memory;
  Fills fills(memory);
  const BoundArgument own = fills.place(Buffer::primitive_a), spare = fills.place(Buffer::primitive_b),
                      other = fills.place(Buffer::primitive_c);
  const auto first = make_backend("tbb:threads=2,lanes=4"), second = make_backend("tbb:threads=2,lanes=4");
  std::atomic<bool> done = false;
  std::thread one([&] {
    fills.run(*first, own);
    fills.run(*first, spare);
    done.store(true, std::memory_order_relaxed);
  });
  std::thread two([&] {
    while (!done.load(std::memory_order_relaxed)) std::this_thread::yield();
    fills.run(*second, on_one_buffer ? own : other);
  });
  one.join();
  two.join();
}

} // namespace

int main(int count, char **arguments)
{
  const std::string what = count > 1 ? arguments[1] : "";
  if (what == "race" || what == "no-race") launch_in_two_threads(what == "race");
  else if (count == 4 && (what == "overrun" || what == "exact"))
    step_with(arguments[2], arguments[3], what == "overrun");
  else return 2;
  std::puts("nothing was seen");
  return 0;
}
