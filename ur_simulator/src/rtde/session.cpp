#include "rtde/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ur_simulator::rtde {
namespace {

constexpr std::uint8_t output_recipe_id = 1;
constexpr std::size_t max_input_recipes = 255;    // the recipe id is one byte; 0 reports an invalid recipe
constexpr std::size_t max_package_size = 0xffff;  // the size field has two bytes
constexpr unsigned max_warnings = 100;
constexpr double protocol_version_1_frequency = 125.0;  // Hz

/// Frequency of the control loop, which is the highest output frequency, Hz.
double control_frequency(const PolyscopeVersion & version)
{
  return version.is_e_series() ? 500.0 : 125.0;
}

/// The types of a recipe reply. Empty if they do not fit into a package, which is the case only for invalid
/// recipes: NOT_FOUND can be longer than the requested name.
std::string join_types(const std::vector<std::string_view> & types)
{
  std::string joined = fmt::format("{}", fmt::join(types, ","));
  constexpr std::size_t max_size = max_package_size - header_size - sizeof(output_recipe_id);
  return joined.size() <= max_size ? joined : std::string();
}

std::string with_recipe_id(std::uint8_t id, std::string_view types)
{
  return static_cast<char>(id) + std::string(types);
}

}  // namespace

Session::Session(std::shared_ptr<Connection> connection, ServerContext & context)
    : connection_(std::move(connection)),
      context_(context),
      output_frequency_(control_frequency(context.version))
{
}

void Session::handle_disconnect()
{
  started_ = false;
  std::erase_if(context_.input_owners,
                [this](const auto & owner) { return owner.second == connection_->id(); });
  context_.log.info("rtde", fmt::format("client {} disconnected", connection_->id()));
  connection_->log().note("data packages: {} sent, {} dropped, {} received", sent_packages_,
                          dropped_packages_, received_packages_);
}

ClientRole Session::role() const
{
  if (input_recipes_.empty()) {
    return output_fields_.empty() ? ClientRole::unknown : ClientRole::receive;
  }
  return output_fields_.empty() ? ClientRole::io : ClientRole::control;
}

// ---- receiving packages

void Session::receive(std::string_view bytes)
{
  received_.append(bytes);
  std::size_t begin = 0;
  while (connection_->is_open() && received_.size() - begin >= header_size) {
    PackageReader header(std::string_view(received_).substr(begin, header_size));
    const std::size_t size = header.read_u16();
    const std::uint8_t type = header.read_u8();
    if (size < header_size) {
      // The start of the next package is unknown.
      disconnect(fmt::format("package size is {}, the header alone has {} bytes", size, header_size));
      return;
    }
    if (received_.size() - begin < size) {
      break;
    }
    handle_package(type, std::string_view(received_).substr(begin + header_size, size - header_size));
    begin += size;
  }
  received_.erase(0, begin);
}

void Session::handle_package(std::uint8_t type, std::string_view payload)
{
  switch (static_cast<PackageType>(type)) {
    case PackageType::request_protocol_version:
      return handle_request_protocol_version(payload);
    case PackageType::get_urcontrol_version:
      return handle_get_urcontrol_version();
    case PackageType::text_message:
      return handle_text_message(payload);
    case PackageType::data_package:
      return handle_data_package(payload);
    case PackageType::setup_outputs:
      return handle_setup_outputs(payload);
    case PackageType::setup_inputs:
      return handle_setup_inputs(payload);
    case PackageType::start:
      return handle_start();
    case PackageType::pause:
      connection_->log().from_peer("pause");
      started_ = false;
      return reply_accepted(PackageType::pause, true);
  }
  send_warning(fmt::format("Unknown package type {}", type));
}

// ---- negotiation and synchronization

void Session::handle_request_protocol_version(std::string_view payload)
{
  PackageReader reader(payload);
  const std::uint16_t version = reader.read_u16();
  connection_->log().from_peer("requests RTDE protocol version {}", version);
  const bool supported = reader.ok() && (version == 1 || version == 2);
  if (supported && version != protocol_version_) {
    protocol_version_ = version;
    set_output_recipe("");  // packages of the versions differ in length
    started_ = false;
  }
  reply_accepted(PackageType::request_protocol_version, supported);
}

void Session::handle_get_urcontrol_version()
{
  std::array<char, 16> payload;
  PackageWriter writer(payload.data());
  for (const std::uint32_t part :
       {context_.version.major, context_.version.minor, context_.version.bugfix, context_.version.build}) {
    writer.put(part);
  }
  connection_->log().from_peer("requests the controller version");
  connection_->log().to_peer("{}", context_.version.to_string());
  reply(PackageType::get_urcontrol_version, std::string_view(payload.data(), payload.size()));
}

void Session::handle_text_message(std::string_view payload)
{
  PackageReader reader(payload);
  std::string_view text;
  if (protocol_version_ == 1) {
    reader.read_u8();  // level
    text = reader.read_remaining();
  } else {
    text = reader.read_bytes(reader.read_u8());
  }
  context_.log.info("rtde", fmt::format("client {} says: {}", connection_->id(), text));
  connection_->log().from_peer("text message: {}", text);
}

void Session::handle_start()
{
  connection_->log().from_peer("start");
  const bool can_start = output_recipe_valid_ && (!output_fields_.empty() || !input_recipes_.empty());
  started_ = can_start;
  publish_phase_ = 1.0 - output_frequency_ / control_frequency(context_.version);
  reply_accepted(PackageType::start, can_start);
}

// ---- outputs

void Session::handle_setup_outputs(std::string_view payload)
{
  PackageReader reader(payload);
  const double frequency = protocol_version_ == 1 ? protocol_version_1_frequency : reader.read_f64();
  const std::string_view names = reader.read_remaining();
  connection_->log().from_peer("requests outputs at {:g} Hz: {}", frequency, names);
  set_output_frequency(frequency);
  const std::string types = set_output_recipe(names);
  const std::uint8_t id = output_recipe_valid_ ? output_recipe_id : 0;
  log_recipe_reply(connection_->log(), id, names, types);
  reply(PackageType::setup_outputs, protocol_version_ == 1 ? types : with_recipe_id(id, types));
}

void Session::set_output_frequency(double frequency)
{
  const double highest = control_frequency(context_.version);
  if (!std::isfinite(frequency) || frequency <= 0.0) {
    send_warning(fmt::format("Output frequency must be above 0 and at most {} Hz", highest));
    frequency = highest;
  }
  output_frequency_ = std::min(frequency, highest);
}

std::string Session::set_output_recipe(std::string_view names)
{
  output_fields_.clear();
  output_recipe_valid_ = true;
  std::vector<std::string_view> types;
  std::size_t size = header_size + (protocol_version_ == 1 ? 0 : sizeof(output_recipe_id));
  for (const std::string_view name : split_names(names)) {
    const OutputField * field = find_output_field(name, context_.version);
    types.push_back(field != nullptr ? type_name(field->type) : "NOT_FOUND");
    output_recipe_valid_ = output_recipe_valid_ && field != nullptr;
    if (field != nullptr) {
      output_fields_.push_back(field);
      size += encoded_size(field->type);
    }
  }
  output_recipe_valid_ = output_recipe_valid_ && size <= max_package_size;
  data_package_.assign(output_recipe_valid_ ? size : 0, '\0');
  return join_types(types);
}

void Session::publish()
{
  if (!started_ || output_fields_.empty() || !output_recipe_valid_) {
    return;
  }
  publish_phase_ += output_frequency_ / control_frequency(context_.version);
  constexpr double rounding_error = 1e-9;
  if (publish_phase_ < 1.0 - rounding_error) {
    return;
  }
  publish_phase_ = std::fmod(publish_phase_ + rounding_error, 1.0) - rounding_error;

  PackageWriter writer(data_package_.data());
  writer.put(static_cast<std::uint16_t>(data_package_.size()));
  writer.put(static_cast<std::uint8_t>(PackageType::data_package));
  if (protocol_version_ != 1) {
    writer.put(output_recipe_id);
  }
  for (const OutputField * field : output_fields_) {
    field->write(context_.state, field->index, writer);
  }
  if (!connection_->send_or_drop(data_package_)) {
    ++dropped_packages_;
  } else if (sent_packages_++ == 0) {
    connection_->log().to_peer("data packages of {} bytes", data_package_.size());
  }
}

// ---- inputs

std::string_view Session::input_type_or_error(const InputField * field) const
{
  if (field == nullptr) {
    return "NOT_FOUND";
  }
  const auto owner = context_.input_owners.find(field);
  const bool in_use = owner != context_.input_owners.end() && owner->second != connection_->id();
  return in_use ? "IN_USE" : type_name(field->type);
}

void Session::claim_inputs(const std::vector<const InputField *> & fields)
{
  for (const InputField * field : fields) {
    context_.input_owners[field] = connection_->id();
  }
}

void Session::handle_setup_inputs(std::string_view payload)
{
  connection_->log().from_peer("requests inputs: {}", payload);
  InputRecipe recipe;
  std::vector<std::string_view> types;
  bool valid = input_recipes_.size() < max_input_recipes;
  for (const std::string_view name : split_names(payload)) {
    const InputField * field = find_input_field(name, context_.version);
    types.push_back(input_type_or_error(field));
    valid = valid && types.back() != "NOT_FOUND" && types.back() != "IN_USE";
    recipe.fields.push_back(field);
  }
  valid = valid && !recipe.fields.empty();
  std::uint8_t id = 0;
  if (valid) {
    claim_inputs(recipe.fields);
    input_recipes_.push_back(std::move(recipe));
    id = static_cast<std::uint8_t>(input_recipes_.size());
  }
  const std::string joined_types = join_types(types);
  log_recipe_reply(connection_->log(), id, payload, joined_types);
  reply(PackageType::setup_inputs, with_recipe_id(id, joined_types));
}

void Session::handle_data_package(std::string_view payload)
{
  PackageReader reader(payload);
  const unsigned id = reader.read_u8();
  if (!reader.ok() || id == 0 || id > input_recipes_.size()) {
    log_warning(fmt::format("data package for recipe {}, which was not set up (there are {})", id,
                            input_recipes_.size()));
    return;
  }
  read_input_fields(input_recipes_[id - 1], reader.read_remaining(), id);
}

void Session::read_input_fields(InputRecipe & recipe, std::string_view values, unsigned recipe_id)
{
  // Some packages of ur_rtde are longer or shorter than their recipe. The fields that the package contains
  // are read in order; the others keep their last value.
  PackageReader reader(values);
  std::size_t recipe_size = 0;
  std::size_t fields_read = 0;
  for (const InputField * field : recipe.fields) {
    recipe_size += encoded_size(field->type);
    if (reader.remaining() < encoded_size(field->type)) {
      reader.read_remaining();
      continue;
    }
    field->read(reader, field->index, context_.state, masked_inputs_);
    ++fields_read;
  }
  apply_masked_inputs(masked_inputs_, context_.state);
  ++received_packages_;
  if (connection_->log()) {
    recipe.log.add(connection_->log(), recipe_id, recipe.fields, values, context_.state.timestamp);
  }
  if (context_.on_data_package) {
    context_.on_data_package(std::span(recipe.fields).first(fields_read));
  }
  if (recipe_size != values.size() && !recipe.wrong_size_logged) {
    recipe.wrong_size_logged = true;
    log_warning(fmt::format("data package for recipe {} has {} bytes, the recipe {}", recipe_id,
                            values.size(), recipe_size));
  }
}

// ---- logging

void Session::log_warning(std::string_view text)
{
  context_.log.warning("rtde", fmt::format("client {}: {}", connection_->id(), text));
  connection_->log().note("{}", text);
}

void Session::disconnect(const std::string & reason)
{
  context_.log.error("rtde", fmt::format("client {}: {}: disconnected", connection_->id(), reason));
  connection_->close(reason);
}

// ---- sending packages

void Session::reply(PackageType type, std::string_view payload)
{
  std::string package(header_size + payload.size(), '\0');
  PackageWriter writer(package.data());
  writer.put(static_cast<std::uint16_t>(package.size()));
  writer.put(static_cast<std::uint8_t>(type));
  writer.put(payload);
  connection_->send(package);
}

void Session::reply_accepted(PackageType type, bool accepted)
{
  connection_->log().to_peer("{}", accepted ? "accepted" : "rejected");
  reply(type, std::string_view(accepted ? "\1" : "\0", 1));
}

void Session::send_warning(std::string_view text)
{
  if (++warnings_ > max_warnings) {
    disconnect(fmt::format("sent {} invalid packages", warnings_));
    return;
  }
  context_.log.warning("rtde", fmt::format("client {}: {}", connection_->id(), text));
  connection_->log().to_peer("text message: {}", text);
  constexpr std::string_view source = "RTDE";
  constexpr std::uint8_t warning = 2;  // 0 exception, 1 error, 2 warning, 3 info
  text = text.substr(0, 255);          // the length field has one byte
  if (protocol_version_ == 1) {
    reply(PackageType::text_message, static_cast<char>(warning) + std::string(text));
    return;
  }
  std::string payload(1, static_cast<char>(text.size()));
  payload += text;
  payload += static_cast<char>(source.size());
  payload += source;
  payload += static_cast<char>(warning);
  reply(PackageType::text_message, payload);
}

}  // namespace ur_simulator::rtde
