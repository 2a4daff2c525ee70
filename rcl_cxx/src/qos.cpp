#include "rcl_cxx/qos.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <rmw/qos_profiles.h>

#include <utility>

#include "qos_rmw.hpp"
#include "rcl_cxx/error.hpp"

namespace rcl_cxx {
QoS QoS::reliable(std::size_t depth)
{
  QoS qos;
  qos.depth = depth;
  return qos;
}

QoS QoS::best_effort(std::size_t depth)
{
  QoS qos = reliable(depth);
  qos.reliability = ReliabilityPolicy::best_effort;
  return qos;
}

QoS QoS::sensor_data()
{
  return best_effort(rmw_qos_profile_sensor_data.depth);
}

QoS QoS::transient_local(std::size_t depth)
{
  QoS qos = reliable(depth);
  qos.durability = DurabilityPolicy::transient_local;
  return qos;
}

QoS QoS::services_default()
{
  return reliable(rmw_qos_profile_services_default.depth);
}

QoS QoS::parameters()
{
  return reliable(rmw_qos_profile_parameters.depth);
}

QoS QoS::system_default()
{
  QoS qos;
  qos.history = HistoryPolicy::system_default;
  qos.depth = RMW_QOS_POLICY_DEPTH_SYSTEM_DEFAULT;
  qos.reliability = ReliabilityPolicy::system_default;
  qos.durability = DurabilityPolicy::system_default;
  return qos;
}

namespace {
struct Named {
  const char * name;
  QoS (*make)();
};

constexpr Named kNamed[] = {{"default", [] { return QoS::reliable(); }},
                            {"reliable", [] { return QoS::reliable(); }},
                            {"best_effort", [] { return QoS::best_effort(); }},
                            {"sensor_data", [] { return QoS::sensor_data(); }},
                            {"latched", [] { return QoS::transient_local(); }},
                            {"transient_local", [] { return QoS::transient_local(); }},
                            {"services_default", [] { return QoS::services_default(); }},
                            {"parameters", [] { return QoS::parameters(); }},
                            {"system_default", [] { return QoS::system_default(); }}};
}  // namespace

QoS QoS::from_name(std::string_view name)
{
  for (const Named & named : kNamed) {
    if (named.name == name) {
      return named.make();
    }
  }
  throw Error(fmt::format("unknown quality of service '{}', known are: {}", name, fmt::join(names(), ", ")));
}

const std::vector<std::string> & QoS::names()
{
  static const std::vector<std::string> all = [] {
    std::vector<std::string> list;
    for (const Named & named : kNamed) {
      list.emplace_back(named.name);
    }
    return list;
  }();
  return all;
}

QoS QoS::keep_last(std::size_t new_depth) const
{
  QoS qos = *this;
  qos.depth = new_depth;
  return qos;
}

namespace detail {
namespace {
rmw_qos_history_policy_t to_rmw(HistoryPolicy history)
{
  switch (history) {
    case HistoryPolicy::keep_last:
      return RMW_QOS_POLICY_HISTORY_KEEP_LAST;
    case HistoryPolicy::keep_all:
      return RMW_QOS_POLICY_HISTORY_KEEP_ALL;
    case HistoryPolicy::system_default:
      break;
  }
  return RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT;
}

rmw_qos_reliability_policy_t to_rmw(ReliabilityPolicy reliability)
{
  switch (reliability) {
    case ReliabilityPolicy::reliable:
      return RMW_QOS_POLICY_RELIABILITY_RELIABLE;
    case ReliabilityPolicy::best_effort:
      return RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT;
    case ReliabilityPolicy::system_default:
      break;
  }
  return RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT;
}

rmw_qos_durability_policy_t to_rmw(DurabilityPolicy durability)
{
  switch (durability) {
    case DurabilityPolicy::is_volatile:
      return RMW_QOS_POLICY_DURABILITY_VOLATILE;
    case DurabilityPolicy::transient_local:
      return RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL;
    case DurabilityPolicy::system_default:
      break;
  }
  return RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT;
}

rmw_time_t to_rmw(std::chrono::nanoseconds duration)
{
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(duration);
  return {static_cast<std::uint64_t>(seconds.count()),
          static_cast<std::uint64_t>((duration - seconds).count())};
}
}  // namespace

rmw_qos_profile_t to_rmw(const QoS & qos)
{
  rmw_qos_profile_t profile = rmw_qos_profile_default;
  profile.history = to_rmw(qos.history);
  profile.depth = qos.depth;
  profile.reliability = to_rmw(qos.reliability);
  profile.durability = to_rmw(qos.durability);
  if (qos.deadline) {
    profile.deadline = to_rmw(*qos.deadline);
  }
  if (qos.lifespan) {
    profile.lifespan = to_rmw(*qos.lifespan);
  }
  return profile;
}
}  // namespace detail

}  // namespace rcl_cxx
