#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "ur_ros_rtde_trajectory/error.hpp"

namespace ur_ros_rtde {

/// What a command holds exclusively while it runs. `script` replaces the control program and therefore
/// excludes motion and mode as well; `mode` is for modes that may be switched on during a motion (force
/// mode); `none` excludes nothing, and its holder does not move the arm.
enum class Resource { none, io, motion, mode, script };

const char * to_string(Resource resource);
/// The holder may move the arm.
constexpr bool moves_arm(Resource resource)
{
  return resource == Resource::motion || resource == Resource::mode || resource == Resource::script;
}

/// One run of the control program over one connection. What was started in one generation has ended in the
/// next, even if the newest sample shows a robot that is ready.
struct Generation {
  std::uint32_t ends = 0;    ///< programs whose end a sample has shown
  std::uint32_t starts = 0;  ///< control programs that were started, taken over or given up
  std::uint32_t link = 0;    ///< Sample::link
  /// Safety stops, and other states in which the robot cannot move, that have begun.
  std::uint32_t robot_stops = 0;
  /// Of `ends`, those that this driver has brought about: a stop that ends the program, or a script.
  std::uint32_t ended_by_driver = 0;
  std::uint32_t restarted_by_driver = 0;  ///< of `starts`: the control program goes on after a script
  /// Starts of the control program that have failed. An operator may have stopped it before a sample has
  /// shown it running.
  std::uint32_t failed_starts = 0;
  std::uint32_t replacements = 0;  ///< of the control program by another program
  bool operator==(const Generation &) const = default;
};

/// What a goal asks for with Robot::acquire().
struct Claim {
  Resource resource = Resource::motion;
  std::string owner;  ///< name shown to users: "move_l"
  std::string id;     ///< goal id; distinguishes commands of the same name
  /// Switches hand guiding on or off, and is therefore possible during it.
  bool switches_hand_guiding = false;
  /// Changes what force mode relies on, and is therefore not possible during it, nor while a mode is
  /// switched. A script, which would end force mode, is not possible either.
  bool excludes_force_mode = false;
  /// The control program answers no query while this holder uses it.
  bool blocks_queries = false;
  /// Preempts only holders with the same `owner`.
  bool preempts_only_own = false;
  /// Tells this holder why it has to release the resource. Called on any thread; must not wait. Empty: this
  /// holder cannot be preempted.
  std::function<void(const Error & why)> preempt;
};

class Permit;

/// The right to use a resource. Released on destruction; movable, but not while other threads use it. A
/// holder that moves the arm commands it through Robot::control(lease), which rejects its calls once the
/// lease's generation has ended or a stop has taken the arm out of its hands.
class Lease {
 public:
  Lease() = default;
  Lease(Lease &&) noexcept;
  Lease & operator=(Lease &&) noexcept;
  ~Lease();
  /// It was granted, and possibly released since.
  explicit operator bool() const { return permit_ != nullptr; }
  /// The holder's calls are rejected from now on. May be called by any thread, and more than once.
  void release() const;

 private:
  friend class Arbiter;
  friend class Robot;
  struct Table;
  Lease(std::shared_ptr<Table> table, std::shared_ptr<Permit> permit);
  std::shared_ptr<Table> table_;
  std::shared_ptr<Permit> permit_;
};

}  // namespace ur_ros_rtde
