#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "urscript/value.hpp"

namespace ur_simulator::urscript {

/// Instructions of the stack machine with their operands `a` and `b`. "pops" and "pushes" refer to the stack
/// of the thread.
enum class Opcode : std::uint8_t {
  push_constant,          ///< a: constant
  push_none,              ///<
  pop,                    ///<
  load_global,            ///< a: slot
  load_local,             ///< a: slot
  load_global_or_local,   ///< a: global slot, b: local slot; loads the global if it has a value
  store_global,           ///< a: slot; pops
  store_local,            ///< a: slot; pops
  store_global_or_local,  ///< a: global slot, b: local slot; pops
  make_list,              ///< a: count; pops them
  make_pose,              ///< pops six numbers
  make_structure,         ///< a: structure type; pops the members
  index,                  ///< a: 1 or 2 indices; pops them and the container
  member,                 ///< a: name; pops the structure
  store_lvalue,           ///< a: path; pops the value, then the path's indices
  call_method_of_lvalue,  ///< a: path, b: call; pops the arguments, then the path's indices
  call_method_of_value,   ///< b: call; pops the arguments, then the object
  negate,
  logical_not,
  to_boolean,
  binary,                ///< a: Operator; pops two
  jump,                  ///< a: target
  jump_if_false,         ///< a: target; pops
  jump_if_true_or_pop,   ///< a: target; leaves True on the stack if it jumps, else pops
  jump_if_false_or_pop,  ///< a: target; leaves False on the stack if it jumps, else pops
  call,                  ///< a: function, b: arguments on the stack
  call_builtin,          ///< a: builtin, b: arguments on the stack
  default_argument,      ///< a: target; b: local slot; jumps if the caller passed the argument
  return_value,          ///< pops
  run,                   ///< a: function, b: arguments on the stack; pushes the handle
  kill,                  ///< pops the handle
  join,                  ///< pops the handle
  enter_critical,
  exit_critical,
  halt,
};

struct Instruction {
  Opcode op;
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

enum class Storage : std::uint8_t { global, local, global_or_local };

/// One step from a variable to an element: an index, two indices or a member.
struct LvalueStep {
  std::uint8_t indices = 0;  ///< 0: a member
  std::string member;
};

/// An assignable part of a variable, such as `a[i].b`. Its indices are on the stack.
struct Lvalue {
  Storage storage = Storage::local;
  std::uint32_t global_slot = 0;
  std::uint32_t local_slot = 0;
  std::string name;
  std::vector<LvalueStep> steps;
  std::uint32_t indices = 0;  ///< of all steps
};

struct MethodCall {
  std::string name;
  std::uint32_t arguments = 0;
};

struct Function {
  std::string name;
  std::uint32_t entry = 0;
  std::uint32_t parameters = 0;
  std::uint32_t locals = 0;  ///< parameters included
  std::vector<std::string> local_names;
};

/// A compiled program. functions[0] is its body.
struct Code {
  std::string name;
  bool secondary = false;
  std::string source;
  std::vector<Instruction> instructions;
  std::vector<std::int32_t> lines;  ///< source line of each instruction
  std::vector<Value> constants;
  std::vector<Function> functions;
  std::vector<std::string> global_names;
  std::vector<std::string> names;                         ///< of members
  std::vector<std::vector<std::string>> structure_types;  ///< of structures
  std::vector<Lvalue> lvalues;
  std::vector<MethodCall> methods;
};

}  // namespace ur_simulator::urscript
