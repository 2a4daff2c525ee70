#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/types.hpp"

namespace ur_simulator {

/// How an object resists the TCP: spring and damper along its normal, and Coulomb friction.
struct Elasticity {
  double stiffness = 20000.0;  ///< N/m
  double damping = 50.0;       ///< N s/m
  double friction = 0.0;       ///< Coulomb coefficient
};

/// An elastic half space: below the plane through `point` with the outward `normal` (base frame) the TCP is
/// pushed back.
struct Surface {
  Vector3 point = Vector3::Zero();    ///< m
  Vector3 normal = Vector3::UnitZ();  ///< any length except 0; normalized when it is added to the world
  Elasticity elasticity;
};

/// An elastic box: inside, the TCP is pushed back through the nearest face.
struct Box {
  Vector3 center = Vector3::Zero();    ///< m, in the base frame
  Vector3 size = Vector3::Ones();      ///< m, along the axes of the box
  Vector3 rotation = Vector3::Zero();  ///< rotation vector of the axes in the base frame, rad
  Elasticity elasticity;
};

/// A spring between a fixed point and the TCP. It pulls beyond its unloaded length and pushes below it.
struct Spring {
  Vector3 anchor = Vector3::Zero();  ///< m, in the base frame
  double stiffness = 0.0;            ///< N/m
  double damping = 0.0;              ///< N s/m
  double length = 0.0;               ///< m, unloaded
};

/// Throw std::invalid_argument with field, value and limit if a value is not finite or out of range.
/// The normal of a surface is normalized.
Surface checked(const Surface & surface);
Box checked(const Box & box);
Spring checked(const Spring & spring);

/// The objects of one kind, with identifiers that are unique in the list. Does not allocate after
/// construction.
template <typename Object>
class ObjectList {
 public:
  static constexpr std::size_t max_size = 32;

  struct Entry {
    std::uint32_t id;
    Object object;
  };

  ObjectList() { entries_.reserve(max_size); }

  /// Returns the identifier of the object. Throws std::invalid_argument if it is invalid or the list is full.
  std::uint32_t add(const Object & object)
  {
    if (entries_.size() >= max_size) {
      throw std::invalid_argument("there are " + std::to_string(max_size) +
                                  " objects of this kind already, the maximum");
    }
    entries_.push_back({next_id_, checked(object)});
    return next_id_++;
  }
  /// False if there is no object with this identifier.
  bool remove(std::uint32_t id)
  {
    return std::erase_if(entries_, [id](const Entry & entry) { return entry.id == id; }) > 0;
  }
  void clear() { entries_.clear(); }

  std::size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.empty(); }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }

 private:
  std::uint32_t next_id_ = 1;
  std::vector<Entry> entries_;
};

}  // namespace ur_simulator
