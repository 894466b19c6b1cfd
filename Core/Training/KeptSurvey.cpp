// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/KeptSurvey.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Core/Training/Checkpoint.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

namespace inr {

namespace {

TrainingIdentity IdentityOf(const TrainingRun& run, StreamedVolume& volume)
{
  return run.identity(volume.estimate(PsnrEstimate::UsualVoxels), volume.pool());
}

} // namespace

KeptSurvey::KeptSurvey(const VolumeInfo& whole, const TrainingOptions& options,
                       const TrainingGroup& group)
    : Whole(whole), Options(options), Group(group),
      Path(group.size() == 1 ? options.checkpoint.path
                             : SurveyPath(options.checkpoint.path, group.rank()))
{}

bool KeptSurvey::resume(StreamedVolume& volume) const
{
  if (!this->isInAll(this->isThere())) {
    return false;
  }
  const std::optional<TrainingIdentity> kept = this->load(volume);
  if (!this->isInAll(kept.has_value()) || !this->isOfOneTraining(*kept)) {
    return false;
  }
  const TrainingObserver nobody;
  const TrainingRun run(this->Whole, volume.statistics(), this->Options, nobody, &this->Group);
  return this->isInAll(IdentityOf(run, volume) == *kept) &&
         volume.isAsBefore(this->Group.valueOfFirst(this->steps()));
}

void KeptSurvey::keep(StreamedVolume& volume, const TrainingRun& run, bool resumed) const
{
  const CheckpointOptions& checkpoint = this->Options.checkpoint;
  if (this->Group.size() == 1 || checkpoint.path.empty() ||
      (!resumed && volume.surveySeconds() < checkpoint.interval)) {
    return;
  }
  const auto tell = [&](CheckpointEvent event, const std::string& text) {
    checkpoint.tell ? checkpoint.tell(event, text) : void();
  };
  try {
    if (!resumed) {
      RemoveAbandonedFiles(this->Path);
      WriteCheckpoint(this->Path, IdentityOf(run, volume), TrainingState(), {}, volume.state());
    }
    tell(CheckpointEvent::SurveyKept, "'" + this->Path + "' holds what was read");
  } catch (const Error& error) {
    tell(CheckpointEvent::Failed,
         std::string(error.what()) +
             "; a training that goes on from the checkpoint will read all data again");
  }
}

bool KeptSurvey::isInAll(bool mine) const
{
  const std::vector<bool> all = this->Group.valuesOfAll(mine);
  return std::all_of(all.begin(), all.end(), [](bool each) { return each; });
}

bool KeptSurvey::isThere() const
{
  const CheckpointOptions& checkpoint = this->Options.checkpoint;
  const auto exists = [](const std::string& path) {
    std::error_code unknown;
    return std::filesystem::exists(path, unknown);
  };
  return checkpoint.resume && !checkpoint.path.empty() && exists(this->Path) &&
         (this->Group.rank() > 0 || exists(checkpoint.path)); // or who removes it gets rid of none
}

/// Of which training it is; nothing where it cannot be read or is of another kind of volume.
std::optional<TrainingIdentity> KeptSurvey::load(StreamedVolume& volume) const
{
  try {
    const CheckpointFile file(this->Path);
    if (!file.hasSurvey()) {
      return std::nullopt;
    }
    file.loadSurvey(volume.state());
    return volume.resume() ? std::optional(file.identity()) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Processes may have been killed after some of them had written their files.
bool KeptSurvey::isOfOneTraining(const TrainingIdentity& mine) const
{
  std::string text;
  for (const auto& [name, value] : mine) {
    text.append(name).append("\n").append(value).append("\n");
  }
  return this->isInAll(this->Group.fromFirst(text) == text);
}

/// Of the checkpoint; 0 where there is none.
std::uint64_t KeptSurvey::steps() const
{
  try {
    return this->Group.rank() == 0 ? CheckpointFile(this->Options.checkpoint.path).state().steps
                                   : 0;
  } catch (const Error&) {
    return 0;
  }
}

std::string SurveyPath(const std::string& checkpoint, int rank)
{
  return checkpoint + ".rank" + std::to_string(rank);
}

} // namespace inr
