#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <rosidl_typesupport_cpp/service_type_support.hpp>
#include <string>
#include <tl/expected.hpp>

#include "rcl_cxx/node.hpp"
#include "rcl_cxx/qos.hpp"

namespace rcl_cxx {
namespace detail {
class ClientImpl;

struct ErasedClient {
  const rosidl_service_type_support_t * type_support;
  std::shared_ptr<void> (*make_response)();
};
}  // namespace detail

class ClientBase {
 public:
  ClientBase(std::shared_ptr<detail::NodeImpl> node, detail::ErasedClient erased, const std::string & name,
             const QoS & qos);
  /// Drops the pending requests: their futures report std::future_errc::broken_promise.
  virtual ~ClientBase();
  ClientBase(const ClientBase &) = delete;
  ClientBase & operator=(const ClientBase &) = delete;

  const std::string & get_service_name() const noexcept;
  bool service_is_ready() const;
  /// Returns false on timeout and shutdown.
  bool wait_for_service(std::chrono::nanoseconds timeout) const;
  /// The number of requests without a response.
  std::size_t pending_count() const;

 protected:
  using OnResponse = std::function<void(const std::shared_ptr<void> &)>;

  std::int64_t send(const void * request, OnResponse on_response);
  tl::expected<std::shared_ptr<void>, std::string> call_and_wait(const void * request,
                                                                 std::chrono::nanoseconds timeout);

 private:
  std::shared_ptr<detail::ClientImpl> impl_;
};

/// A service client for tests, created by create_client. Thread-safe. Responses arrive in the executor's
/// thread.
template <typename S>
class Client : public ClientBase {
 public:
  using SharedPtr = std::shared_ptr<Client<S>>;
  using Request = typename S::Request;
  using Response = typename S::Response;

  Client(std::shared_ptr<detail::NodeImpl> node, const std::string & name, const QoS & qos)
      : ClientBase(std::move(node),
                   {rosidl_typesupport_cpp::get_service_type_support_handle<S>(),
                    []() -> std::shared_ptr<void> { return std::make_shared<Response>(); }},
                   name, qos)
  {
  }

  /// `callback` runs in the executor's thread. @throws Error if the request cannot be sent.
  void async_send_request(const Request & request, std::function<void(const Response &)> callback)
  {
    send(&request, [callback = std::move(callback)](const std::shared_ptr<void> & response) {
      callback(*static_cast<const Response *>(response.get()));
    });
  }

  /// @throws Error if the request cannot be sent.
  std::future<Response> async_send_request(const Request & request)
  {
    auto promise = std::make_shared<std::promise<Response>>();
    auto future = promise->get_future();
    send(&request, [promise](const std::shared_ptr<void> & response) {
      promise->set_value(*static_cast<const Response *>(response.get()));
    });
    return future;
  }

  /// Waits for the service and the response at most `timeout`. The executor has to spin in another thread.
  /// The error is the reason: no such service, no response, shutdown, or called from a callback of the
  /// executor.
  tl::expected<Response, std::string> call(const Request & request, std::chrono::nanoseconds timeout)
  {
    auto response = call_and_wait(&request, timeout);
    if (!response) {
      return tl::make_unexpected(std::move(response.error()));
    }
    return std::move(*static_cast<Response *>(response->get()));
  }
};

template <typename S>
std::shared_ptr<Client<S>> create_client(const Node & node, const std::string & service,
                                         const QoS & qos = QoS::services_default())
{
  return std::make_shared<Client<S>>(node.impl(), service, qos);
}

}  // namespace rcl_cxx
