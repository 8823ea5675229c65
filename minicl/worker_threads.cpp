/* worker_threads.cpp - starts threads to find how many the machine grants; see worker_threads.h. */
#include "minicl/worker_threads.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <pthread.h>
#include <sys/mman.h>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace tandem::minicl {
namespace {

/* The addresses that the C library reserves for the heap of one thread; for a moment it takes twice as many, to align
 * them. */
constexpr size_t heap_bytes = size_t{128} << 20;

/* Reserves addresses, without memory, so that nothing else can take them meanwhile. */
class Reservation {
public:
  explicit Reservation(size_t bytes)
      : bytes_(bytes), place_(::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0))
  {}
  Reservation(Reservation &&other) noexcept : bytes_(other.bytes_), place_(std::exchange(other.place_, MAP_FAILED)) {}
  ~Reservation()
  {
    if (granted()) ::munmap(place_, bytes_);
  }
  bool granted() const { return place_ != MAP_FAILED; }

private:
  size_t bytes_;
  void *place_;
};

/* Threads that wait at a gate until all of them have started. They allocate nothing. */
class WaitingThreads {
public:
  WaitingThreads(size_t most, size_t stack_bytes) : closed_(gate_)
  {
    threads_.reserve(most);
    reservations_.reserve(most);
    ::pthread_attr_init(&attributes_);
    ::pthread_attr_setstacksize(&attributes_, stack_bytes);
  }
  ~WaitingThreads()
  {
    closed_.unlock();
    for (const pthread_t thread : threads_) ::pthread_join(thread, nullptr);
    ::pthread_attr_destroy(&attributes_);
  }
  WaitingThreads(const WaitingThreads &) = delete;
  WaitingThreads &operator=(const WaitingThreads &) = delete;

  bool start_one()
  {
    Reservation reservation(heap_bytes);
    pthread_t thread;
    if (!reservation.granted() || ::pthread_create(&thread, &attributes_, pass, &gate_) != 0) return false;
    threads_.push_back(thread);
    reservations_.push_back(std::move(reservation));
    return true;
  }
  size_t count() const { return threads_.size(); }

private:
  static void *pass(void *gate)
  {
    const std::lock_guard<std::mutex> lock(*static_cast<std::mutex *>(gate));
    return nullptr;
  }

  std::mutex gate_;
  std::unique_lock<std::mutex> closed_;
  pthread_attr_t attributes_;
  std::vector<pthread_t> threads_;
  std::vector<Reservation> reservations_;
};

/* TBB obeys the lowest of several controls, so there is one, which only grows. */
class WorkerThreads {
public:
  void want(size_t threads)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (threads <= wanted_) return;
    wanted_ = threads;
    settled_ = false;
  }
  size_t settle()
  {
    if (settled_.load(std::memory_order_acquire)) return allowed_;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (settled_) return allowed_;
    allowed_ += startable_threads(wanted_ - allowed_,
                                  tbb::global_control::active_value(tbb::global_control::thread_stack_size));
    auto control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, allowed_);
    control_ = std::move(control); /* the old one is destroyed last, so that there is always one */
    settled_.store(true, std::memory_order_release);
    return allowed_;
  }
  std::string shortage()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!settled_ || allowed_ >= wanted_) return {};
    return fmt::format("only {} of {} threads could be started and took part; the results are the same",
                       allowed_.load(), wanted_);
  }

private:
  std::mutex mutex_;
  std::atomic<bool> settled_ = false;
  size_t wanted_ = static_cast<size_t>(tbb::this_task_arena::max_concurrency());
  std::atomic<size_t> allowed_ = 1; /* including the calling thread */
  std::unique_ptr<tbb::global_control> control_;
};

WorkerThreads &worker_threads()
{
  static WorkerThreads threads;
  return threads;
}

} // namespace

void want_threads(size_t threads) { worker_threads().want(threads); }
size_t settle_threads() { return worker_threads().settle(); }
std::string thread_shortage() { return worker_threads().shortage(); }

/* One thread more than wanted must start, because another process may take one before TBB does. */
size_t startable_threads(size_t wanted, size_t stack_bytes)
{
  if (wanted == 0) return 0;
  WaitingThreads threads(wanted + 1, stack_bytes);
  while (threads.count() <= wanted && threads.start_one()) {}
  return threads.count() - std::min<size_t>(threads.count(), 1);
}

} // namespace tandem::minicl
