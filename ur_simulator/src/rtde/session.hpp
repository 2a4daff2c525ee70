#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "net/connection.hpp"
#include "rtde/server.hpp"

namespace ur_simulator::rtde {

/// One RTDE client: negotiation, recipes, synchronisation.
class Session {
 public:
  Session(std::shared_ptr<Connection> connection, Shared & shared);

  void receive(std::string_view bytes);
  /// Sends the output recipe if it is this client's turn in this cycle.
  void publish();
  /// The connection has ended: gives the input fields back.
  void leave();
  std::uint64_t dropped_packages() const { return dropped_packages_; }
  ClientRole role() const;
  Connection & connection() { return *connection_; }

 private:
  struct InputRecipe {
    std::vector<const InputField *> fields;
    bool wrong_size_reported = false;
  };

  void handle(std::uint8_t type, std::string_view payload);
  void request_protocol_version(std::string_view payload);
  void get_urcontrol_version();
  void text_message(std::string_view payload);
  void setup_outputs(std::string_view payload);
  void setup_inputs(std::string_view payload);
  void start_synchronisation();
  void data_package(std::string_view payload);
  void read_fields(InputRecipe & recipe, std::string_view values, unsigned recipe_id);
  void claim(const std::vector<const InputField *> & fields);
  std::string type_of(const InputField * field) const;

  void reply(PackageType type, std::string_view payload);
  void say(std::string_view text);

  std::shared_ptr<Connection> connection_;
  Shared & shared_;
  std::string received_;
  std::uint16_t protocol_ = 1;  ///< until the client asks for 2
  std::vector<InputRecipe> inputs_;
  MaskedInputs masked_;
  std::vector<const OutputField *> outputs_;
  bool outputs_valid_ = true;
  double frequency_;
  double due_ = 1.0;     ///< a package is due when this reaches 1
  std::string package_;  ///< the outgoing data package, sized at set-up
  bool started_ = false;
  std::uint64_t dropped_packages_ = 0;
};

}  // namespace ur_simulator::rtde
