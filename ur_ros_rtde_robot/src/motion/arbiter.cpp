#include "ur_ros_rtde_robot/motion/arbiter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

namespace ur_ros_rtde {

struct Arbiter::Table {
  struct Entry {
    std::uint64_t key;
    Claim claim;
  };

  static bool conflict(Resource a, Resource b)
  {
    const auto moves = [](Resource resource) {
      return resource == Resource::motion || resource == Resource::script;
    };
    return a != Resource::none && (a == b || (moves(a) && moves(b)));
  }

  /// The mutex must be held.
  const Entry * conflicting_entry(Resource resource) const
  {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const Entry & e) { return conflict(resource, e.claim.resource); });
    return found == entries.end() ? nullptr : &*found;
  }

  std::mutex mutex;
  std::condition_variable released;
  std::vector<Entry> entries;
  std::uint64_t next_key = 1;
};

struct Lease::State {
  std::shared_ptr<Arbiter::Table> table;
  std::uint64_t key;
};

namespace {

std::string name(const Claim & claim)
{
  return claim.id.empty() ? claim.owner : fmt::format("{}, goal {}", claim.owner, claim.id);
}

}  // namespace

const char * to_string(Resource resource)
{
  switch (resource) {
    case Resource::none:
      return "none";
    case Resource::motion:
      return "motion";
    case Resource::io:
      return "io";
    case Resource::script:
      return "script";
  }
  return "unknown";
}

Lease::Lease(std::shared_ptr<State> state) : state_(std::move(state)) {}
Lease::Lease(Lease && other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
Lease & Lease::operator=(Lease && other) noexcept
{
  std::swap(state_, other.state_);
  other.release();
  return *this;
}
Lease::~Lease()
{
  release();
}

void Lease::release()
{
  if (!state_) {
    return;
  }
  const auto state = std::exchange(state_, nullptr);
  {
    const std::lock_guard lock(state->table->mutex);
    std::erase_if(state->table->entries, [&](const auto & entry) { return entry.key == state->key; });
  }
  state->table->released.notify_all();
}

Arbiter::Arbiter() : table_(std::make_shared<Table>()) {}

Expected<Lease> Arbiter::acquire(Claim claim)
{
  const std::lock_guard lock(table_->mutex);
  if (const auto * entry = table_->conflicting_entry(claim.resource)) {
    return failure(ErrorCode::busy,
                   fmt::format("{} is running and holds the resource {}: wait for its end, or cancel it",
                               name(entry->claim), to_string(entry->claim.resource)));
  }
  const auto key = table_->next_key++;
  table_->entries.push_back({key, std::move(claim)});
  return Lease(std::make_shared<Lease::State>(Lease::State{table_, key}));
}

Expected<Lease> Arbiter::acquire_preempting(Claim claim, std::chrono::milliseconds limit)
{
  const auto deadline = std::chrono::steady_clock::now() + limit;
  std::vector<std::uint64_t> asked;
  std::unique_lock lock(table_->mutex);
  while (const auto * entry = table_->conflicting_entry(claim.resource)) {
    if (!entry->claim.preempt) {
      break;
    }
    const auto key = entry->key;
    if (std::find(asked.begin(), asked.end(), key) == asked.end()) {
      asked.push_back(key);
      const auto preempt = entry->claim.preempt;
      lock.unlock();
      preempt(name(claim));
      lock.lock();
      continue;
    }
    if (table_->released.wait_until(lock, deadline) == std::cv_status::timeout) {
      break;
    }
  }
  lock.unlock();
  return acquire(std::move(claim));
}

std::optional<Arbiter::Holder> Arbiter::holder(Resource resource) const
{
  const std::lock_guard lock(table_->mutex);
  if (const auto * entry = table_->conflicting_entry(resource)) {
    return Holder{entry->claim.owner, entry->claim.id};
  }
  return std::nullopt;
}

}  // namespace ur_ros_rtde
