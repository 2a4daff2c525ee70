#include <array>
#include <chrono>
#include <functional>
#include <vector>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 7> link_names{"all",     "rtde",      "dashboard", "script",
                                                     "primary", "secondary", "realtime"};
constexpr std::array<std::string_view, 4> client_names{"all", "control", "receive", "io"};

std::vector<Listener *> chosen(Bench & bench, const std::string & which)
{
  std::vector<Listener *> listeners;
  for (const auto & [name, listener] : bench.links) {
    const bool script = name == "primary" || name == "secondary" || name == "realtime";
    if (which == "all" || which == name || (which == "script" && script)) {
      listeners.push_back(listener);
    }
  }
  return listeners;
}

/// Does something to the connections that the fields "which" and "clients" choose; answers how many.
json to_connections(Bench & bench, Fields & fields, const std::function<void(Connection &)> & action)
{
  const std::string which = fields.choice("which", link_names, "all");
  const std::string clients = fields.choice("clients", client_names, "all");
  fields.finish();
  std::size_t count = 0;
  const auto counted = [&](Connection & connection) {
    ++count;
    action(connection);
  };
  if (clients == "all") {
    for (Listener * listener : chosen(bench, which)) {
      listener->for_each(counted);
    }
  } else if (which == "all" || which == "rtde") {
    const rtde::ClientRole role = clients == "control"   ? rtde::ClientRole::control
                                  : clients == "receive" ? rtde::ClientRole::receive
                                                         : rtde::ClientRole::io;
    bench.rtde.for_each(role, counted);
  } else {
    throw RequestError("field 'clients' is '" + clients +
                       "': only links of 'rtde' can be chosen by what they are for");
  }
  return {{"connections", count}};
}

json drop_links(Bench & bench, Fields & fields)
{
  const bool reset = fields.boolean("reset", false);
  return to_connections(
      bench, fields, [reset](Connection & connection) { reset ? connection.reset() : connection.close(); });
}

json stall_links(Bench & bench, Fields & fields)
{
  const bool stalled = fields.boolean("stalled", true);
  return to_connections(bench, fields, [stalled](Connection & connection) { connection.stall(stalled); });
}

json delay_links(Bench & bench, Fields & fields)
{
  const std::chrono::milliseconds by(fields.integer("ms", 0, 60000));
  return to_connections(bench, fields, [by](Connection & connection) { connection.delay(by); });
}

json lose_commands(Bench & bench, Fields & fields)
{
  const auto count = static_cast<std::uint64_t>(fields.integer("count", 0, 1000000, 1));
  return to_connections(bench, fields, [count](Connection & connection) { connection.lose(count); });
}

json send_garbage(Bench & bench, Fields & fields)
{
  const auto bytes = static_cast<std::size_t>(fields.integer("bytes", 1, 65536, 64));
  std::string garbage(bytes, '\0');
  for (std::size_t i = 0; i < bytes; ++i) {
    garbage[i] = static_cast<char>((i * 167 + 13) % 256);
  }
  return to_connections(bench, fields, [&garbage](Connection & connection) { connection.send(garbage); });
}

json refuse_connections(Bench & bench, Fields & fields)
{
  const std::string which = fields.choice("which", link_names, "all");
  fields.finish();
  for (Listener * listener : chosen(bench, which)) {
    listener->set_accepting(false);
  }
  return json::object();
}

json accept_connections(Bench & bench, Fields & fields)
{
  const std::string which = fields.choice("which", link_names, "all");
  fields.finish();
  for (Listener * listener : chosen(bench, which)) {
    listener->set_accepting(true);
  }
  return json::object();
}

json fieldbus(Bench & bench, Fields & fields)
{
  const bool on = fields.boolean("on", true);
  fields.finish();
  return {{"taken_by_others", bench.rtde.set_fieldbus(on)}};
}

json reboot(Bench & bench, Fields & fields)
{
  const double duration = fields.number("duration", {0.0, 600.0}, 1.0);
  fields.finish();
  bench.reboot(duration);
  return json::object();
}

constexpr std::array link_command_table{
    Command{"drop_links",
            "which all|rtde|dashboard|script|primary|secondary|realtime (all); clients "
            "all|control|receive|io (all); reset "
            "true|false (false)",
            "Closes connections, in order or with a reset.", drop_links},
    Command{
        "stall_links", "which, clients as drop_links; stalled true|false (true)",
        "Connections stay open but nothing is read or sent, as behind a pulled cable; false lets them go on.",
        stall_links},
    Command{"delay_links", "which, clients as drop_links; ms 0..60000",
            "Everything on these connections is so late, both ways; 0 ends it. New connections are not late.",
            delay_links},
    Command{"lose_commands", "which, clients as drop_links; count (1)",
            "The next pieces of data that these clients send are lost.", lose_commands},
    Command{"send_garbage", "which, clients as drop_links; bytes 1..65536 (64)",
            "Sends bytes that mean nothing.", send_garbage},
    Command{"refuse_connections", "which (all)", "Closes ports; open connections stay.", refuse_connections},
    Command{"accept_connections", "which (all)", "Opens them again.", accept_connections},
    Command{"fieldbus", "on true|false (true)",
            "A fieldbus of the installation has the input registers of the lower range that are free: IN_USE "
            "for RTDE clients. Answers how many a client had already.",
            fieldbus},
    Command{"reboot", "duration s (1)",
            "Resets all connections, is away for so long and comes back powered off, its clock at 0.",
            reboot},
};

}  // namespace

std::span<const Command> link_commands()
{
  return link_command_table;
}

}  // namespace ur_simulator::control_port
