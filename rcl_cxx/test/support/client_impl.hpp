#pragma once

#include <rcl/client.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tl/expected.hpp>

#include "executor/waitable.hpp"
#include "rcl_cxx_test/client.hpp"
#include "rcl_support/type_support.hpp"

namespace rcl_cxx::detail {
class ClientImpl : public Waitable {
 public:
  using OnResponse = std::function<void(const std::shared_ptr<void> &)>;

  ClientImpl(std::shared_ptr<NodeImpl> node, ErasedClient erased, const std::string & name, const QoS & qos);
  ~ClientImpl() override;

  bool service_is_ready() const;
  bool wait_for_service(std::chrono::nanoseconds timeout) const;
  std::int64_t send(const void * request, OnResponse on_response);
  tl::expected<std::shared_ptr<void>, std::string> call(const void * request,
                                                        std::chrono::nanoseconds timeout);
  std::size_t pending_count() const;
  void forget_all();

  const std::string & get_service_name() const noexcept { return name_; }

  void set_on_ready_callbacks() override;

 protected:
  void execute(std::size_t source) override;
  void clear_on_ready_callbacks() noexcept override;

 private:
  OnResponse take_pending(std::int64_t sequence);

  const ErasedClient erased_;
  const ServiceTypeSupport type_support_;
  rcl_client_t client_ = rcl_get_zero_initialized_client();
  std::string name_;
  mutable std::mutex mutex_;
  std::map<std::int64_t, OnResponse> pending_;
};

}  // namespace rcl_cxx::detail
