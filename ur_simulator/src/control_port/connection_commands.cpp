#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <vector>

#include "control_port/commands.hpp"

namespace ur_simulator::control_port {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 11> server_names{"all",      "rtde",    "dashboard",  "robot_api",
                                                        "modbus",   "script",  "primary",    "secondary",
                                                        "realtime", "robotiq", "interpreter"};
constexpr std::array<std::string_view, 6> not_script_ports{"rtde",   "dashboard", "robot_api",
                                                           "modbus", "robotiq",   "interpreter"};
constexpr std::array<std::string_view, 4> client_names{"all", "control", "receive", "io"};

std::vector<Listener *> select_listeners(ControlPortContext & context, const std::string & which)
{
  std::vector<Listener *> listeners;
  for (const auto & [name, listener] : context.listeners) {
    const bool script = std::ranges::find(not_script_ports, name) == not_script_ports.end();
    // "primary" also selects "primary_read_only".
    if (which == "all" || name.starts_with(which) || (which == "script" && script)) {
      listeners.push_back(listener);
    }
  }
  return listeners;
}

rtde::ClientRole role_of(const std::string & client_name)
{
  if (client_name == "control") {
    return rtde::ClientRole::control;
  }
  return client_name == "receive" ? rtde::ClientRole::receive : rtde::ClientRole::io;
}

/// Calls `visit` for the connections that the fields "which" and "clients" select. The reply contains their
/// number.
Action for_selected_connections(RequestFields & fields, const std::function<void(Connection &)> & visit)
{
  const std::string which = fields.choice("which", server_names, "all");
  const std::string clients = fields.choice("clients", client_names, "all");
  if (clients != "all" && which != "all" && which != "rtde") {
    throw RequestError(
        fmt::format("field 'clients' is '{}': it applies to connections of 'rtde' only", clients), "clients");
  }
  return [=](ControlPortContext & context) -> json {
    std::size_t count = 0;
    const auto counted_visit = [&](Connection & connection) {
      ++count;
      visit(connection);
    };
    if (clients != "all") {
      context.rtde.for_each_connection(role_of(clients), counted_visit);
    } else {
      for (Listener * listener : select_listeners(context, which)) {
        listener->for_each_connection(counted_visit);
      }
    }
    return {{"connections", count}};
  };
}

Action drop_links(RequestFields & fields)
{
  const bool reset = fields.boolean("reset", false);
  return for_selected_connections(fields, [reset](Connection & connection) {
    reset ? connection.reset() : connection.close("drop_links");
  });
}

Action stall_links(RequestFields & fields)
{
  const bool stalled = fields.boolean("stalled", true);
  return for_selected_connections(fields,
                                  [stalled](Connection & connection) { connection.set_stalled(stalled); });
}

Action delay_links(RequestFields & fields)
{
  const std::chrono::milliseconds delay(fields.integer("ms", 0, 60000));
  return for_selected_connections(fields, [delay](Connection & connection) { connection.set_delay(delay); });
}

Action lose_commands(RequestFields & fields)
{
  const auto count = static_cast<std::uint64_t>(fields.integer("count", 0, 1000000, 1));
  return for_selected_connections(fields,
                                  [count](Connection & connection) { connection.discard_next_reads(count); });
}

Action send_garbage(RequestFields & fields)
{
  const auto bytes = static_cast<std::size_t>(fields.integer("bytes", 1, 65536, 64));
  std::string garbage(bytes, '\0');
  for (std::size_t i = 0; i < bytes; ++i) {
    garbage[i] = static_cast<char>((i * 167 + 13) % 256);
  }
  return for_selected_connections(fields, [garbage](Connection & connection) { connection.send(garbage); });
}

/// Opens or closes the ports that the field "which" selects.
template <bool accepting>
Action set_accepting(RequestFields & fields)
{
  const std::string which = fields.choice("which", server_names, "all");
  return [=](ControlPortContext & context) -> json {
    for (Listener * listener : select_listeners(context, which)) {
      listener->set_accepting(accepting);
    }
    return json::object();
  };
}

Action fieldbus(RequestFields & fields)
{
  const bool on = fields.boolean("on", true);
  return [=](ControlPortContext & context) -> json {
    return {{"taken_by_others", context.rtde.set_fieldbus_enabled(on)}};
  };
}

Action reboot(RequestFields & fields)
{
  const double duration = fields.number("duration", {0.0, 600.0}, 1.0);
  return [=](ControlPortContext & context) -> json {
    context.reboot(duration);
    return json::object();
  };
}

constexpr std::array connection_command_table{
    Command{"drop_links",
            "which all|rtde|dashboard|robot_api|modbus|script|primary|secondary|realtime|interpreter|robotiq "
            "(all); "
            "clients "
            "all|control|receive|io (all); reset true|false (false)",
            "Closes connections, orderly or with a TCP reset.", drop_links},
    Command{"stall_links", "which, clients: see drop_links; stalled true|false (true)",
            "Stops reading and sending on connections and leaves them open, as if the cable were unplugged; "
            "false resumes.",
            stall_links},
    Command{"delay_links", "which, clients: see drop_links; ms 0..60000",
            "Delays all data on existing connections in both directions; 0 ends the delay.", delay_links},
    Command{"lose_commands", "which, clients: see drop_links; count (1)",
            "Discards the next pieces of data that the clients send.", lose_commands},
    Command{"send_garbage", "which, clients: see drop_links; bytes 1..65536 (64)", "Sends meaningless bytes.",
            send_garbage},
    Command{"refuse_connections", "which (all)", "Closes ports; existing connections stay open.",
            set_accepting<false>},
    Command{"accept_connections", "which (all)", "Opens ports again.", set_accepting<true>},
    Command{"fieldbus", "on true|false (true)",
            "Reserves the free input registers of the lower range for a fieldbus: IN_USE for RTDE clients. "
            "Returns the number of registers that clients already use.",
            fieldbus},
    Command{"reboot", "duration s (1)",
            "Resets all connections and switches off; after the duration the controller is powered off "
            "and its clock starts at 0.",
            reboot},
};

}  // namespace

std::span<const Command> connection_commands()
{
  return connection_command_table;
}

}  // namespace ur_simulator::control_port
