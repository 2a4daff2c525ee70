#include "rcl_cxx_test/client.hpp"

#include <fmt/format.h>
#include <rcl/graph.h>

#include "client_impl.hpp"
#include "events/event_queue.hpp"
#include "node/node_impl.hpp"
#include "rcl_support/rcl_error.hpp"
#include "rcl_support/type_support.hpp"
#include "wait.hpp"

namespace rcl_cxx {
namespace detail {
namespace {
// A wait for a response checks for a shutdown this often.
constexpr std::chrono::milliseconds kShutdownCheckPeriod{20};
}  // namespace

ClientImpl::ClientImpl(std::shared_ptr<NodeImpl> node, ErasedClient erased, const std::string & name,
                       const QoS & qos)
    : Waitable(std::move(node), fmt::format("client of {}", name)),
      erased_(erased),
      type_support_(erased_.type_support)
{
  rcl_client_options_t options = rcl_client_get_default_options();
  options.qos = qos.get_rmw_qos_profile();
  const std::lock_guard lock(this->node()->mutex());
  check_rcl(rcl_client_init(&client_, this->node()->handle(), type_support_.get(), name.c_str(), &options),
            label(), "cannot be created");
  reset_type_support_error();
  name_ = rcl_client_get_service_name(&client_);
}

ClientImpl::~ClientImpl()
{
  const std::lock_guard lock(node()->mutex());
  ignore_rcl(rcl_client_fini(&client_, node()->handle()));
}

bool ClientImpl::service_is_ready() const
{
  bool ready = false;
  if (rcl_service_server_is_available(node()->handle(), &client_, &ready) != RCL_RET_OK) {
    rcl_reset_error();  // after the shutdown
    return false;
  }
  return ready;
}

bool ClientImpl::wait_for_service(std::chrono::nanoseconds timeout) const
{
  return wait_for(*node(), [this] { return service_is_ready(); }, timeout);
}

std::int64_t ClientImpl::send(const void * request, OnResponse on_response)
{
  std::int64_t sequence = 0;
  const std::lock_guard lock(mutex_);  // the response may arrive before the call returns
  check_rcl(rcl_send_request(&client_, request, &sequence), label(), "cannot send a request");
  pending_.emplace(sequence, std::move(on_response));
  return sequence;
}

tl::expected<std::shared_ptr<void>, std::string> ClientImpl::call(const void * request,
                                                                  std::chrono::nanoseconds timeout)
{
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  if (node()->default_group()->pending_events().in_own_callback()) {
    return tl::make_unexpected(
        fmt::format("{}: a blocking call from a callback never returns, use async_send_request", name_));
  }
  if (!wait_for_service(timeout)) {
    return tl::make_unexpected(fmt::format("{}: there is no such service", name_));
  }
  auto promise = std::make_shared<std::promise<std::shared_ptr<void>>>();
  auto answer = promise->get_future();
  std::int64_t sequence = 0;
  try {
    sequence =
        send(request, [promise](const std::shared_ptr<void> & response) { promise->set_value(response); });
  } catch (const Error & error) {
    return tl::make_unexpected(std::string(error.what()));
  }
  while (answer.wait_for(kShutdownCheckPeriod) != std::future_status::ready) {
    if (node()->get_context().ok() && std::chrono::steady_clock::now() < deadline) {
      continue;
    }
    take_pending(sequence);
    return tl::make_unexpected(fmt::format(
        "{}: {}", name_, node()->get_context().ok() ? "no response within the timeout" : "shutting down"));
  }
  try {
    return answer.get();
  } catch (const std::future_error &) {
    return tl::make_unexpected(fmt::format("{}: the client was destroyed during the call", name_));
  }
}

std::size_t ClientImpl::pending_count() const
{
  const std::lock_guard lock(mutex_);
  return pending_.size();
}

void ClientImpl::forget_all()
{
  std::map<std::int64_t, OnResponse> dropped;
  const std::lock_guard lock(mutex_);
  dropped.swap(pending_);
}

ClientImpl::OnResponse ClientImpl::take_pending(std::int64_t sequence)
{
  const std::lock_guard lock(mutex_);
  auto node = pending_.extract(sequence);
  return node.empty() ? OnResponse{} : std::move(node.mapped());
}

void ClientImpl::execute(std::size_t /*source*/)
{
  const std::shared_ptr<void> response = erased_.make_response();
  rmw_request_id_t id;
  const rcl_ret_t code = rcl_take_response(&client_, &id, response.get());
  if (code == RCL_RET_CLIENT_TAKE_FAILED) {
    rcl_reset_error();
    return;
  }
  check_rcl(code, label(), "cannot take a response");
  if (const OnResponse on_response = take_pending(id.sequence_number)) {
    on_response(response);
  }
}

void ClientImpl::set_on_ready_callbacks()
{
  set_callback(rcl_client_set_on_new_response_callback, client_, 0);
}

void ClientImpl::clear_on_ready_callbacks() noexcept
{
  clear_callback(rcl_client_set_on_new_response_callback, client_);
}
}  // namespace detail

ClientBase::ClientBase(std::shared_ptr<detail::NodeImpl> node, detail::ErasedClient erased,
                       const std::string & name, const QoS & qos)
    : impl_(detail::make_waitable<detail::ClientImpl>(std::move(node), erased, name, qos))
{
}

ClientBase::~ClientBase()
{
  impl_->close();
  impl_->forget_all();
}

const std::string & ClientBase::get_service_name() const noexcept
{
  return impl_->get_service_name();
}
bool ClientBase::service_is_ready() const
{
  return impl_->service_is_ready();
}
bool ClientBase::wait_for_service(std::chrono::nanoseconds timeout) const
{
  return impl_->wait_for_service(timeout);
}
std::size_t ClientBase::pending_count() const
{
  return impl_->pending_count();
}

std::int64_t ClientBase::send(const void * request, OnResponse on_response)
{
  return impl_->send(request, std::move(on_response));
}

tl::expected<std::shared_ptr<void>, std::string> ClientBase::call_and_wait(const void * request,
                                                                           std::chrono::nanoseconds timeout)
{
  return impl_->call(request, timeout);
}

}  // namespace rcl_cxx
