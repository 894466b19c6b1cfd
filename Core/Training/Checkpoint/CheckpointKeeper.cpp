// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Checkpoint/CheckpointKeeper.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Core/Timer.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

namespace inr {

namespace {

/// Seconds between two checkpoints, for each that writing one takes.
constexpr double LeastShare = 20;

/// What tells two trainings apart, for the user; empty = nothing.
std::string Difference(const TrainingIdentity& there, const TrainingIdentity& here)
{
  const auto valueOf = [](const TrainingIdentity& identity, const std::string& name) {
    const auto entry = identity.find(name);
    return entry == identity.end() ? std::string("not told") : entry->second;
  };
  TrainingIdentity all = here;
  all.insert(there.begin(), there.end());
  for (const auto& [name, unused] : all) {
    const std::string was = valueOf(there, name);
    const std::string is = valueOf(here, name);
    if (was != is) {
      return name + " is " + was + " there and " + is + " here";
    }
  }
  return "";
}

/// Or cannot be seen.
bool Exists(const std::string& path)
{
  std::error_code unknown;
  return std::filesystem::exists(path, unknown) || unknown;
}

bool IsFile(const std::string& path)
{
  std::error_code unknown;
  return std::filesystem::is_regular_file(path, unknown);
}

/// Renames a file to one that is not there yet; a folder or a device is not ours to move.
void SetAside(const std::string& path)
{
  if (!IsFile(path)) {
    return;
  }
  const std::string first = path + ".other";
  std::string name = first;
  std::error_code error;
  for (int number = 2; std::filesystem::exists(name, error) && !error; ++number) {
    name = first + std::to_string(number);
  }
  std::filesystem::rename(path, name, error);
  if (error && Exists(path)) {
    throw Error(ErrorCode::CannotWrite,
                "cannot rename '" + path + "' to '" + name + "': " + error.message());
  }
}

} // namespace

CheckpointKeeper::CheckpointKeeper(CheckpointOptions options, TrainingIdentity identity)
    : Options(std::move(options)), Identity(std::move(identity))
{
  if (!this->Options.path.empty()) {
    RemoveAbandonedFiles(this->Options.path);
  }
}

std::optional<TrainingState> CheckpointKeeper::resume(const StateArrays& arrays)
{
  const std::string& path = this->Options.path;
  if (path.empty() || !this->Options.resume || !Exists(path)) {
    return std::nullopt;
  }
  this->IsOthers = true; // whatever it is, until it has proved to be of use
  try {
    const CheckpointFile file(path);
    const std::string difference = Difference(file.identity(), this->Identity);
    if (!difference.empty()) {
      throw Error(ErrorCode::InvalidArgument,
                  "'" + path + "' is of another training: " + difference);
    }
    file.load(arrays);
    this->IsOthers = false;
    this->HasWritten = true;
    this->HasAll = file.state().finished;
    this->tell(CheckpointEvent::Resumed, "the training goes on after " +
                                             std::to_string(file.state().steps) + " steps from '" +
                                             path + "'");
    return file.state();
  } catch (const Error& error) {
    const std::string after = ", and its first checkpoint will leave the file under another name, "
                              "'.other' at its end";
    this->tell(CheckpointEvent::Ignored, std::string(error.what()) + "; the training begins anew" +
                                             (IsFile(path) ? after : ""));
    return std::nullopt;
  }
}

bool CheckpointKeeper::isDue() const
{
  return !this->Options.path.empty() &&
         this->SinceWritten.seconds() >=
             std::max(this->Options.interval, LeastShare * this->WriteSeconds);
}

/// Whether the checkpoint of before is there still, which somebody may have taken away.
bool CheckpointKeeper::isKept() const { return this->HasWritten && Exists(this->Options.path); }

/// Replaces the checkpoint; says why it cannot, and otherwise nothing.
std::string CheckpointKeeper::replace(const TrainingState& state, const StateArrays& arrays)
{
  const Timer clock;
  std::string problem;
  try {
    if (this->IsOthers) {
      SetAside(this->Options.path);
      this->IsOthers = false;
    }
    WriteCheckpoint(this->Options.path, this->Identity, state, arrays, this->Survey);
    this->HasWritten = true;
    this->HasAll = state.finished;
    this->tell(CheckpointEvent::Written,
               "'" + this->Options.path + "' holds " + std::to_string(state.steps) + " steps");
  } catch (const Error& error) {
    problem = error.what();
  } catch (const std::bad_alloc&) {
    problem = "there is not enough memory to write '" + this->Options.path + "'";
  }
  this->WriteSeconds = clock.seconds();
  this->SinceWritten = TrainingClock();
  return problem;
}

void CheckpointKeeper::write(const TrainingState& state, const StateArrays& arrays)
{
  const std::string problem = this->replace(state, arrays);
  if (!problem.empty() && !std::exchange(this->HasFailed, true)) {
    this->tell(CheckpointEvent::Failed,
               problem + "; the training goes on, " +
                   (this->isKept() ? "the checkpoint of before is kept" : "without a checkpoint"));
  }
}

void CheckpointKeeper::writeAtEnd(const TrainingState& state, const StateArrays& arrays)
{
  if (!this->Options.path.empty() && state.seconds >= this->Options.interval) {
    this->write(state, arrays);
  }
}

std::string CheckpointKeeper::writeAtStop(const TrainingState& state, const StateArrays& arrays)
{
  if (this->Options.path.empty() || state.steps == 0) {
    return "nothing was kept";
  }
  const std::string problem = this->HasAll ? "" : this->replace(state, arrays);
  if (problem.empty()) {
    return "its " + std::to_string(state.steps) + " steps are kept in '" + this->Options.path +
           "', from where the same training goes on";
  }
  return problem + (this->isKept() ? "; the checkpoint of before is kept" : "; nothing was kept");
}

void CheckpointKeeper::tell(CheckpointEvent event, const std::string& text) const
{
  if (this->Options.tell) {
    this->Options.tell(event, text);
  }
}

} // namespace inr
