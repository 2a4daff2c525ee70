#pragma once

#include <rcl/service.h>

#include <memory>
#include <string>

#include "entity.hpp"
#include "rcl_cxx/qos.hpp"
#include "rcl_cxx/service.hpp"
#include "response_retry.hpp"

namespace rcl_cxx::detail {
class ServiceCore : public Entity {
 public:
  static std::shared_ptr<ServiceCore> create(std::shared_ptr<NodeCore> node, ErasedService erased,
                                             const std::string & name, const QoS & qos);
  ServiceCore(std::shared_ptr<NodeCore> node, ErasedService erased, const std::string & name,
              const QoS & qos);
  ~ServiceCore() override;

  const std::string & service_name() const noexcept { return name_; }

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
