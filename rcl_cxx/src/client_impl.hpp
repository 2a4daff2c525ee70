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

#include "rcl_cxx/client.hpp"
#include "rcl_cxx/qos.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
class ClientImpl : public Waitable {
 public:
  using OnResponse = std::function<void(const std::shared_ptr<void> &)>;

  static std::shared_ptr<ClientImpl> create(std::shared_ptr<NodeImpl> node, ErasedClient erased,
                                            const std::string & name, const QoS & qos);
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

 protected:
  void execute(std::size_t source) override;
  void stop() noexcept override;

 private:
  OnResponse take_pending(std::int64_t sequence);

  const ErasedClient erased_;
  rcl_client_t client_;
  std::string name_;
  mutable std::mutex mutex_;
  std::map<std::int64_t, OnResponse> pending_;
};

}  // namespace rcl_cxx::detail
