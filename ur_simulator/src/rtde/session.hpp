#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "net/connection.hpp"
#include "rtde/server.hpp"
#include "rtde/session_log.hpp"

namespace ur_simulator::rtde {

/// The RTDE session of one client: protocol negotiation, recipes, synchronization.
class Session {
 public:
  Session(std::shared_ptr<Connection> connection, ServerContext & context);

  void receive(std::string_view bytes);
  /// Sends the output recipe if the output frequency requires a package in this cycle.
  void publish();
  /// Releases the client's input fields.
  void handle_disconnect();
  std::uint64_t dropped_packages() const { return dropped_packages_; }
  ClientRole role() const;
  Connection & connection() { return *connection_; }

 private:
  struct InputRecipe {
    std::vector<const InputField *> fields;
    bool wrong_size_logged = false;
    DataPackageLog log;
  };

  void handle_package(std::uint8_t type, std::string_view payload);
  void handle_request_protocol_version(std::string_view payload);
  void handle_get_urcontrol_version();
  void handle_text_message(std::string_view payload);
  void handle_setup_outputs(std::string_view payload);
  void handle_setup_inputs(std::string_view payload);
  void handle_start();
  void handle_data_package(std::string_view payload);
  void set_output_frequency(double frequency);
  /// Sets the output recipe. Returns the comma-separated types of the fields, NOT_FOUND for unknown fields.
  std::string set_output_recipe(std::string_view names);
  void read_input_fields(InputRecipe & recipe, std::string_view values, unsigned recipe_id);
  void claim_inputs(const std::vector<const InputField *> & fields);
  /// The type of the field, NOT_FOUND if it is null, or IN_USE if another client has it.
  std::string_view input_type_or_error(const InputField * field) const;

  void reply(PackageType type, std::string_view payload);
  /// Accepts or rejects a request.
  void reply_accepted(PackageType type, bool accepted);
  void log_warning(std::string_view text);
  void disconnect(const std::string & reason);
  /// Sends a text message of level WARNING to the client and logs it.
  void send_warning(std::string_view text);

  std::shared_ptr<Connection> connection_;
  ServerContext & context_;
  std::string received_;
  std::uint16_t protocol_version_ = 1;  ///< the initial version of the protocol
  std::vector<InputRecipe> input_recipes_;
  MaskedInputs masked_inputs_;
  std::vector<const OutputField *> output_fields_;
  bool output_recipe_valid_ = true;
  double output_frequency_;     ///< Hz
  double publish_phase_ = 1.0;  ///< output periods since the last package; a package is due at 1
  std::string data_package_;    ///< buffer of the outgoing data package
  bool started_ = false;
  unsigned warnings_ = 0;                ///< sent to the client
  std::uint64_t sent_packages_ = 0;      ///< data packages
  std::uint64_t dropped_packages_ = 0;   ///< data packages
  std::uint64_t received_packages_ = 0;  ///< data packages
};

}  // namespace ur_simulator::rtde
