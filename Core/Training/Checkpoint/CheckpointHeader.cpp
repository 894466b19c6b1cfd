// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Checkpoint/CheckpointHeader.h"

#include "Core/Error.h"
#include "Core/Model/JsonSection.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>

namespace inr {

namespace {

using nlohmann::json;

std::uint64_t Count(const JsonSection& section, const char* key)
{
  const std::int64_t value = section.integer(key);
  if (value < 0) {
    section.refuse(key, "is negative");
  }
  return static_cast<std::uint64_t>(value);
}

double FiniteNumber(const JsonSection& section, const char* key)
{
  const double value = section.number(key);
  if (!std::isfinite(value)) {
    section.refuse(key, "is not finite");
  }
  return value;
}

TrainingIdentity ParseIdentity(const JsonSection& section)
{
  TrainingIdentity identity;
  for (const auto& [name, value] : section.find("training")->items()) {
    if (!value.is_string()) {
      section.refuse("training", "holds something that is no text");
    }
    identity.emplace(name, value.get<std::string>());
  }
  return identity;
}

/// Without what is nested more deeply than a header is.
json ParseText(const std::string& text)
{
  constexpr int deepest = 4;
  const auto keep = [](int depth, json::parse_event_t, json&) { return depth <= deepest; };
  json header = json::parse(text, keep, /*allow_exceptions=*/false);
  if (!header.is_object()) {
    throw Error(ErrorCode::Malformed, "its header is not a JSON object");
  }
  return header;
}

} // namespace

CheckpointHeader::CheckpointHeader(TrainingIdentity whose, const TrainingState& at,
                                   std::int64_t bytesOfSurvey, std::int64_t bytesOfTraining)
    : identity(std::move(whose)), state(at), surveyBytes(bytesOfSurvey),
      trainingBytes(bytesOfTraining)
{}

std::string CheckpointHeader::text() const
{
  json header = {{"training", this->identity},
                 {"steps", this->state.steps},
                 {"planned_steps", this->state.plannedSteps},
                 {"seconds", this->state.seconds},
                 {"psnr", std::isfinite(this->state.psnr) ? this->state.psnr : 0.0},
                 {"finished", this->state.finished}};
  if (this->state.anew > 0) {
    header["began_anew"] = this->state.anew;
  }
  if (this->surveyBytes > 0) {
    header["survey_bytes"] = this->surveyBytes;
    header["training_bytes"] = this->trainingBytes;
  }
  return header.dump(-1, ' ', /*ensure_ascii=*/true, json::error_handler_t::replace);
}

CheckpointHeader::CheckpointHeader(const std::string& text)
{
  const json header = ParseText(text);
  const JsonSection section(header, "header");
  if (!section.section("training").present()) {
    section.refuse("training", "is missing");
  }
  this->identity = ParseIdentity(section);
  this->state.steps = Count(section, "steps");
  this->state.plannedSteps = Count(section, "planned_steps");
  this->state.seconds = FiniteNumber(section, "seconds");
  this->state.psnr = FiniteNumber(section, "psnr");
  this->state.finished = section.boolean("finished", false);
  if (this->state.seconds < 0) {
    section.refuse("seconds", "is negative");
  }
  if (section.has("began_anew")) {
    this->state.anew = Count(section, "began_anew");
  }
  if (section.has("survey_bytes")) {
    this->surveyBytes = static_cast<std::int64_t>(Count(section, "survey_bytes"));
    this->trainingBytes = static_cast<std::int64_t>(Count(section, "training_bytes"));
  }
}

} // namespace inr
