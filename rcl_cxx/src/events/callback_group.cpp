#include "rcl_cxx/callback_group.hpp"

#include "events/event_queue.hpp"

namespace rcl_cxx {

CallbackGroup::CallbackGroup() : pending_events_(std::make_unique<detail::PendingEvents>()) {}
CallbackGroup::~CallbackGroup() = default;

}  // namespace rcl_cxx
