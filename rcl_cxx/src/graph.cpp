#include <rcl/graph.h>
#include <rcutils/types/string_array.h>

#include <algorithm>

#include "node_impl.hpp"
#include "rcl_cxx/node.hpp"
#include "rcl_error.hpp"

/// What a node knows of the other ones.
namespace rcl_cxx {
namespace {
class StringArray {
 public:
  ~StringArray()
  {
    if (rcutils_string_array_fini(&array_) != RCUTILS_RET_OK) {
      rcl_reset_error();
    }
  }
  rcutils_string_array_t * get() { return &array_; }
  const char * operator[](std::size_t i) const { return array_.data[i]; }
  std::size_t size() const { return array_.size; }

 private:
  rcutils_string_array_t array_ = rcutils_get_zero_initialized_string_array();
};

class RclNamesAndTypes {
 public:
  ~RclNamesAndTypes() { detail::ignore_rcl(rcl_names_and_types_fini(&value_)); }
  rcl_names_and_types_t * get() { return &value_; }

  Node::NamesAndTypes to_map() const
  {
    Node::NamesAndTypes map;
    for (std::size_t i = 0; i < value_.names.size; ++i) {
      const rcutils_string_array_t & types = value_.types[i];
      map.emplace(value_.names.data[i], std::vector<std::string>(types.data, types.data + types.size));
    }
    return map;
  }

 private:
  rcl_names_and_types_t value_ = rcl_get_zero_initialized_names_and_types();
};
}  // namespace

std::size_t Node::count_publishers(const std::string & topic) const
{
  std::size_t count = 0;
  detail::check_rcl(rcl_count_publishers(impl_->handle(), resolve_topic_name(topic).c_str(), &count), topic,
                    "its publishers cannot be counted");
  return count;
}

std::size_t Node::count_subscribers(const std::string & topic) const
{
  std::size_t count = 0;
  detail::check_rcl(rcl_count_subscribers(impl_->handle(), resolve_topic_name(topic).c_str(), &count), topic,
                    "its subscribers cannot be counted");
  return count;
}

std::vector<std::string> Node::get_node_names() const
{
  StringArray names;
  StringArray namespaces;
  detail::check_rcl(
      rcl_get_node_names(impl_->handle(), rcl_get_default_allocator(), names.get(), namespaces.get()),
      get_fully_qualified_name(), "the nodes cannot be listed");
  std::vector<std::string> result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string space = namespaces[i];
    result.push_back(space + (space.ends_with('/') ? "" : "/") + names[i]);
  }
  return result;
}

Node::NamesAndTypes Node::get_topic_names_and_types() const
{
  RclNamesAndTypes topics;
  rcl_allocator_t allocator = rcl_get_default_allocator();
  detail::check_rcl(rcl_get_topic_names_and_types(impl_->handle(), &allocator, false, topics.get()),
                    get_fully_qualified_name(), "the topics cannot be listed");
  return topics.to_map();
}

Node::NamesAndTypes Node::get_service_names_and_types() const
{
  RclNamesAndTypes services;
  rcl_allocator_t allocator = rcl_get_default_allocator();
  detail::check_rcl(rcl_get_service_names_and_types(impl_->handle(), &allocator, services.get()),
                    get_fully_qualified_name(), "the services cannot be listed");
  return services.to_map();
}

bool Node::wait_for_publishers(const std::string & topic, std::size_t count,
                               std::chrono::nanoseconds timeout) const
{
  return impl_->wait_for([&] { return count_publishers(topic) >= count; }, timeout);
}

bool Node::wait_for_subscribers(const std::string & topic, std::size_t count,
                                std::chrono::nanoseconds timeout) const
{
  return impl_->wait_for([&] { return count_subscribers(topic) >= count; }, timeout);
}

bool Node::wait_for_node(const std::string & name, std::chrono::nanoseconds timeout) const
{
  return impl_->wait_for(
      [&] {
        const auto names = get_node_names();
        return std::find(names.begin(), names.end(), name) != names.end();
      },
      timeout);
}

}  // namespace rcl_cxx
