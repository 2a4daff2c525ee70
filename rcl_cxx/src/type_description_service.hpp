#pragma once

#include <memory>

#include "parameters.hpp"
#include "rcl_cxx/node.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
/// ~/get_type_description, where rcl offers it and the parameter start_type_description_service (read-only,
/// true) does not forbid it. Destroy with the node.
class TypeDescriptionService {
 public:
  TypeDescriptionService(const std::shared_ptr<NodeImpl> & node, Parameters & parameters);
  ~TypeDescriptionService();
  TypeDescriptionService(const TypeDescriptionService &) = delete;
  TypeDescriptionService & operator=(const TypeDescriptionService &) = delete;

 private:
  std::shared_ptr<Waitable> impl_;
};

}  // namespace rcl_cxx::detail
