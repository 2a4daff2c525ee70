#include "rcl_cxx/qos.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <rmw/qos_profiles.h>

#include "rcl_cxx/error.hpp"

namespace rcl_cxx {
namespace {
struct NamedQos {
  const char * name;
  QoS (*make)();
};

constexpr NamedQos kNamed[] = {{"default", [] { return QoS::reliable(); }},
                               {"reliable", [] { return QoS::reliable(); }},
                               {"best_effort", [] { return QoS::best_effort(); }},
                               {"sensor_data", [] { return QoS::sensor_data(); }},
                               {"latched", [] { return QoS::transient_local(); }},
                               {"transient_local", [] { return QoS::transient_local(); }},
                               {"services_default", [] { return QoS::services_default(); }},
                               {"parameters", [] { return QoS::parameters(); }},
                               {"system_default", [] { return QoS::system_default(); }}};
}  // namespace

QoS QoS::reliable(std::size_t depth)
{
  return QoS(rmw_qos_profile_default).keep_last(depth);
}

QoS QoS::best_effort(std::size_t depth)
{
  return sensor_data().keep_last(depth);
}

QoS QoS::sensor_data()
{
  return QoS(rmw_qos_profile_sensor_data);
}

QoS QoS::transient_local(std::size_t depth)
{
  QoS qos = reliable(depth);
  qos.profile_.durability = RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL;
  return qos;
}

QoS QoS::services_default()
{
  return QoS(rmw_qos_profile_services_default);
}

QoS QoS::parameters()
{
  return QoS(rmw_qos_profile_parameters);
}

QoS QoS::system_default()
{
  return QoS(rmw_qos_profile_system_default);
}

QoS QoS::from_name(std::string_view name)
{
  for (const NamedQos & named : kNamed) {
    if (named.name == name) {
      return named.make();
    }
  }
  throw Error(
      fmt::format("unknown quality of service '{}', it must be one of: {}", name, fmt::join(names(), ", ")));
}

const std::vector<std::string> & QoS::names()
{
  static const std::vector<std::string> all = [] {
    std::vector<std::string> list;
    for (const NamedQos & named : kNamed) {
      list.emplace_back(named.name);
    }
    return list;
  }();
  return all;
}

QoS QoS::keep_last(std::size_t depth) const
{
  QoS qos = *this;
  qos.profile_.depth = depth;
  return qos;
}

bool operator==(const QoS & a, const QoS & b) noexcept
{
  const rmw_qos_profile_t & x = a.profile_;
  const rmw_qos_profile_t & y = b.profile_;
  return x.history == y.history && x.depth == y.depth && x.reliability == y.reliability &&
         x.durability == y.durability;
}

}  // namespace rcl_cxx
