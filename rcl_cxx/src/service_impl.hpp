#pragma once

#include <rcl/service.h>

#include <memory>
#include <string>

#include "rcl_cxx/qos.hpp"
#include "rcl_cxx/service.hpp"
#include "response_retry.hpp"
#include "waitable.hpp"

namespace rcl_cxx::detail {
class ServiceImpl : public Waitable {
 public:
  static std::shared_ptr<ServiceImpl> create(std::shared_ptr<NodeImpl> node, ErasedService erased,
                                             const std::string & name, const QoS & qos);
  ServiceImpl(std::shared_ptr<NodeImpl> node, ErasedService erased, const std::string & name,
              const QoS & qos);
  ~ServiceImpl() override;

  const std::string & get_service_name() const noexcept { return name_; }

 protected:
  void execute(std::size_t source) override;
  void stop() noexcept override;

 private:
  void respond(const rmw_request_id_t & id, const std::shared_ptr<void> & response);

  const ErasedService erased_;
  const std::shared_ptr<ResponseRetry> answers_;
  rcl_service_t service_;
  std::string name_;
};

}  // namespace rcl_cxx::detail
