/* call_log.cpp - see call_log.h; and how a world begins, continues and ends a recording. */
#include "host/world/call_log.h"

#include <cerrno>
#include <cstring>

#include <tandem/version.h>

#include "host/base/hash.h"
#include "host/runtime/parts.h"
#include "host/world/implementation.h"

namespace tandem {
namespace {

constexpr uint64_t bodies_a_step = 1024; /* hashes of bodies, on average over the steps */

} // namespace

std::vector<uint32_t> body_hashes(Memory &memory, const std::vector<uint32_t> &order)
{
  const size_t n = order.size();
  const auto position = memory.read<float4>(Buffer::body_position, 2 * n),
             orientation = memory.read<float4>(Buffer::body_orientation, n),
             velocity = memory.read<float4>(Buffer::body_velocity, 2 * n);
  std::vector<uint32_t> hashes(n);
  for (size_t i = 0; i < n; ++i) {
    uint64_t hash = hash_bytes(&position[2 * i], 2 * sizeof(float4));
    hash = hash_bytes(&orientation[i], sizeof(float4), hash);
    hashes[order[i]] = static_cast<uint32_t>(hash_bytes(&velocity[2 * i], 2 * sizeof(float4), hash));
  }
  return hashes;
}

CallLog::CallLog(const std::string &path, const RecordingOptions &options)
    : path_(path), file_(std::fopen(path.c_str(), "wb")), options_(options)
{
  if (!file_) throw InputError(fmt::format("recording '{}': cannot write: {}", path, std::strerror(errno)));
  write(recording_magic.data(), recording_magic.size());
  write(&recording_format, sizeof recording_format);
  writer_.put(RecordedPart::header);
  writer_.put(std::string(version()));
  write_part();
}

CallLog::~CallLog() = default;

void CallLog::write(const void *bytes, size_t count)
{
  if (std::fwrite(bytes, 1, count, file_.get()) != count)
    throw InputError(fmt::format("cannot write: {}", std::strerror(errno)));
}

/* Each part is flushed, so that it outlives a crash of the program. */
void CallLog::write_part()
{
  const std::vector<std::byte> part = writer_.take();
  writer_ = {};
  const uint64_t bytes = part.size(), hash = hash_blocks(part.data(), part.size(), parts_, run_parts);
  write(&bytes, sizeof bytes);
  write(&hash, sizeof hash);
  write(part.data(), part.size());
  if (std::fflush(file_.get()) != 0) throw InputError(fmt::format("cannot write: {}", std::strerror(errno)));
  ++parts_;
}

void CallLog::begin_calls()
{
  if (writer_.size() == 0) writer_.put(RecordedPart::calls);
}

void CallLog::end_step(const StepHashes &hashes) noexcept
{
  put(RecordedCall::step, hashes);
  guarded([&] { write_part(); });
  ++steps_;
}

void CallLog::put_snapshot(std::span<const std::byte> bytes) noexcept
{
  guarded([&] {
    writer_.put(RecordedPart::snapshot);
    writer_.put(steps_);
    put_field(bytes);
    write_part();
  });
}

void CallLog::fail(const std::string &why) noexcept
{
  failed_ = true;
  try {
    why_ = why;
  } catch (const std::bad_alloc &) { /* finish() then says less */
  }
}

void CallLog::finish()
{
  guarded([&] {
    if (writer_.size() > 0) write_part();
    writer_.put(RecordedPart::end);
    writer_.put(steps_);
    write_part();
    if (std::fclose(file_.release()) != 0) throw InputError(fmt::format("cannot write: {}", std::strerror(errno)));
  });
  if (failed_)
    throw InputError(fmt::format("recording '{}': it ends after {} steps or earlier: {}", path_, steps_, why_));
}

/* States that were kept before are none of the recording. */
void World::Implementation::start_recording(const std::string &path, const RecordingOptions &options)
{
  const std::vector<std::byte> snapshot = save();
  auto fresh = std::make_unique<CallLog>(path, options);
  fresh->put_snapshot(snapshot);
  const auto states = static_cast<uint32_t>(ring.size());
  if (states > 0) {
    const bool after_steps = ring.keeps_after_steps();
    keep_states(states, after_steps);
    fresh->put(RecordedCall::keep_states, states, after_steps);
  }
  plan.hits = 0; /* which no snapshot holds */
  log = std::move(fresh);
}

void World::Implementation::log_step()
{
  if (!log) return;
  try {
    StepHashes hashes;
    const uint64_t every = 1 + bodies() / (bodies_a_step + 1);
    if (log->options().hashes) hashes.state = state_hash();
    if (log->options().hashes && log->steps() % every == 0) hashes.bodies = body_hashes(memory, special.order);
    log->end_step(hashes);
    const uint64_t snapshots = log->options().snapshot_every;
    if (snapshots > 0 && log->steps() % snapshots == 0 && ring.size() == 0) log->put_snapshot(save());
  } catch (const std::exception &error) {
    log->fail(error.what());
  }
}

} // namespace tandem
