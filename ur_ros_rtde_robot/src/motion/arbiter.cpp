#include "motion/arbiter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace ur_ros_rtde {
namespace {

bool excludes(const Claim & a, const Claim & b)
{
  return (a.resource == Resource::script && moves_arm(b.resource)) ||
         (a.excludes_force_mode && b.resource == Resource::mode);
}

bool conflicts(const Claim & a, const Claim & b)
{
  if (a.resource == Resource::none || b.resource == Resource::none) {
    return false;
  }
  return a.resource == b.resource || excludes(a, b) || excludes(b, a);
}

bool may_preempt(const Claim & claim, const Claim & holder)
{
  return holder.preempt && (!claim.preempts_only_own || holder.owner == claim.owner);
}

std::string name(const Claim & claim)
{
  return claim.id.empty() ? claim.owner : fmt::format("{}, goal {}", claim.owner, claim.id);
}

}  // namespace

struct Lease::Table {
  std::mutex mutex;
  std::condition_variable_any released;
  std::vector<std::shared_ptr<Permit>> permits;
  std::vector<const Claim *> waiting;

  /// The mutex must be held.
  std::shared_ptr<Permit> conflicting(const Claim & claim) const
  {
    const auto found = std::find_if(permits.begin(), permits.end(),
                                    [&](const auto & permit) { return conflicts(claim, permit->claim()); });
    return found == permits.end() ? nullptr : *found;
  }

  std::vector<std::function<void(const Error &)>> preempt_functions_of_waiting(const Claim & newest)
  {
    std::vector<std::function<void(const Error &)>> functions;
    const std::lock_guard lock(mutex);
    for (const Claim * claim : waiting) {
      if (conflicts(newest, *claim) && may_preempt(newest, *claim)) {
        functions.push_back(claim->preempt);
      }
    }
    return functions;
  }

  /// A claim that waits for its resource. The mutex must be held at both ends of its lifetime.
  class Waiting {
   public:
    Waiting(Table & table, const Claim & claim) : table_(table), claim_(&claim)
    {
      table_.waiting.push_back(claim_);
    }
    ~Waiting() { std::erase(table_.waiting, claim_); }
    Waiting(const Waiting &) = delete;
    Waiting & operator=(const Waiting &) = delete;

   private:
    Table & table_;
    const Claim * const claim_;
  };

  /// Tells the holders of the resource to release it, and waits for that.
  void preempt_holders(std::unique_lock<std::mutex> & lock, const Claim & claim, const Error & why,
                       Permit::Clock::time_point deadline, const std::stop_token & stop)
  {
    std::vector<std::shared_ptr<Permit>> asked;
    while (const auto holder = conflicting(claim)) {
      if (!may_preempt(claim, holder->claim())) {
        return;
      }
      if (std::find(asked.begin(), asked.end(), holder) == asked.end()) {
        if (!asked.empty() && stop.stop_requested()) {
          return;  // the holder has come after what ends this claim
        }
        asked.push_back(holder);
        lock.unlock();
        holder->claim().preempt(why);
        lock.lock();
        continue;
      }
      const auto is_released = [&] { return conflicting(claim) != holder; };
      if (!released.wait_until(lock, stop, deadline, is_released)) {
        return;
      }
    }
  }

  /// The mutex must be held.
  static Expected<Lease> grant(const std::shared_ptr<Table> & table, Claim claim,
                               const Arbiter::Admission & admit)
  {
    if (const auto holder = table->conflicting(claim)) {
      return failure(ErrorCode::busy,
                     fmt::format("{} is running and holds the resource {}: wait for its end, or cancel it",
                                 name(holder->claim()), to_string(holder->claim().resource)));
    }
    const auto generation = admit();
    if (!generation) {
      return tl::unexpected(generation.error());
    }
    auto permit = std::make_shared<Permit>(std::move(claim), *generation);
    table->permits.push_back(permit);
    return Lease(table, std::move(permit));
  }
};

const char * to_string(Resource resource)
{
  switch (resource) {
    case Resource::none:
      return "none";
    case Resource::io:
      return "io";
    case Resource::motion:
      return "motion";
    case Resource::mode:
      return "mode";
    case Resource::script:
      return "script";
  }
  return "unknown";
}

Lease::Lease(std::shared_ptr<Table> table, std::shared_ptr<Permit> permit)
    : table_(std::move(table)), permit_(std::move(permit))
{
}
Lease::Lease(Lease && other) noexcept
    : table_(std::exchange(other.table_, nullptr)), permit_(std::exchange(other.permit_, nullptr))
{
}
Lease & Lease::operator=(Lease && other) noexcept
{
  std::swap(table_, other.table_);
  std::swap(permit_, other.permit_);
  other.release();
  return *this;
}
Lease::~Lease()
{
  release();
}

void Lease::release() const
{
  if (!permit_) {
    return;
  }
  permit_->revoke(Error{ErrorCode::canceled, "this goal has ended"});
  {
    const std::lock_guard lock(table_->mutex);
    std::erase(table_->permits, permit_);
  }
  table_->released.notify_all();
}

Arbiter::Arbiter() : table_(std::make_shared<Lease::Table>()) {}

Expected<Lease> Arbiter::acquire(Claim claim, const Admission & admit)
{
  const std::lock_guard lock(table_->mutex);
  return Lease::Table::grant(table_, std::move(claim), admit);
}

Expected<Lease> Arbiter::acquire_preempting(const Claim & claim, const Admission & admit, const Retry & retry,
                                            Permit::Clock::time_point deadline, const std::stop_token & stop)
{
  const Error why{ErrorCode::preempted, fmt::format("preempted by {}", name(claim))};
  for (const auto & preempt : table_->preempt_functions_of_waiting(claim)) {
    preempt(why);  // the newest claim wins
  }
  std::unique_lock lock(table_->mutex);
  const Lease::Table::Waiting waiting(*table_, claim);
  while (true) {
    table_->preempt_holders(lock, claim, why, deadline, stop);
    auto lease = Lease::Table::grant(table_, claim, admit);
    if (lease || table_->conflicting(claim)) {
      return lease;
    }
    lock.unlock();
    const bool again = retry();
    lock.lock();
    if (!again || stop.stop_requested()) {
      return lease;
    }
  }
}

std::shared_ptr<const Permit> Arbiter::holder(Resource resource) const
{
  const std::lock_guard lock(table_->mutex);
  Claim claim;
  claim.resource = resource;
  return table_->conflicting(claim);
}

std::vector<std::shared_ptr<Permit>> Arbiter::arm_holders() const
{
  std::vector<std::shared_ptr<Permit>> holders;
  const std::lock_guard lock(table_->mutex);
  for (const auto & permit : table_->permits) {
    if (moves_arm(permit->claim().resource)) {
      holders.push_back(permit);
    }
  }
  return holders;
}

bool Arbiter::wait_for_revoked_holders(std::chrono::milliseconds timeout) const
{
  std::unique_lock lock(table_->mutex);
  return table_->released.wait_for(lock, timeout, [this] {
    return std::none_of(table_->permits.begin(), table_->permits.end(), [](const auto & permit) {
      return moves_arm(permit->claim().resource) && permit->revoked();
    });
  });
}

}  // namespace ur_ros_rtde
