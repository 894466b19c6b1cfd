// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Streaming/KeptSurvey.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"
#include "Core/Training/Checkpoint/Checkpoint.h"
#include "Core/Training/TrainingIdentity.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

namespace inr {

namespace {

constexpr const char* RankSuffix = ".rank";

TrainingIdentity IdentityOf(const TrainingRun& run, StreamedVolume& volume)
{
  return run.identity(volume.estimate(PsnrEstimate::UsualVoxels), volume.pool());
}

/// Whatever trained: see HaveSameSamples.
std::string ToText(const TrainingIdentity& identity)
{
  std::string text;
  for (const auto& [name, value] : WithoutKernel(identity)) {
    text.append(name).append("\n").append(value).append("\n");
  }
  return text;
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
  if (!this->Group.all(this->isThere())) {
    return false;
  }
  const std::optional<TrainingIdentity> kept = this->load(volume);
  const Before before = this->before();
  if (!this->Group.all(kept.has_value()) || !this->isOfTheTraining(*kept, before)) {
    return false;
  }
  const TrainingObserver nobody;
  const TrainingRun run(this->Whole, volume.statistics(), this->Options, nobody, &this->Group);
  return this->Group.all(HaveSameSamples(IdentityOf(run, volume), *kept)) &&
         volume.isAsBefore(this->Group.valueOfFirst(before.steps));
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

bool KeptSurvey::isThere() const
{
  const CheckpointOptions& checkpoint = this->Options.checkpoint;
  std::error_code unknown;
  return checkpoint.resume && !checkpoint.path.empty() &&
         std::filesystem::exists(this->Path, unknown);
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

/// Of which the checkpoint is that rank 0 has, in all processes: they may have been killed after
/// some of them had written their files, or the checkpoint been removed, so that it is begun anew.
bool KeptSurvey::isOfTheTraining(const TrainingIdentity& mine, const Before& before) const
{
  return this->Group.all(this->Group.fromFirst(before.training) == ToText(mine));
}

/// Nothing in all processes but rank 0, and where there is no checkpoint.
KeptSurvey::Before KeptSurvey::before() const
{
  if (this->Group.rank() > 0) {
    return {};
  }
  try {
    const CheckpointFile file(this->Options.checkpoint.path);
    return {ToText(file.identity()), file.state().steps};
  } catch (const Error&) {
    return {};
  }
}

std::string SurveyPath(const std::string& checkpoint, int rank)
{
  return checkpoint + RankSuffix + std::to_string(rank);
}

void RemoveSurveys(const std::string& checkpoint)
{
  namespace fs = std::filesystem;
  const fs::path path(checkpoint);
  const std::string begin = path.filename().string() + RankSuffix;
  const auto isSurvey = [&](const std::string& name) {
    return name.size() > begin.size() && name.compare(0, begin.size(), begin) == 0 &&
           std::all_of(name.begin() + static_cast<std::ptrdiff_t>(begin.size()), name.end(),
                       [](char c) { return c >= '0' && c <= '9'; });
  };
  std::error_code ignored;
  std::vector<fs::path> surveys;
  for (fs::directory_iterator entry(fs::absolute(path, ignored).parent_path(), ignored), end;
       !ignored && entry != end; entry.increment(ignored)) {
    if (isSurvey(entry->path().filename().string())) {
      surveys.push_back(entry->path());
    }
  }
  for (const fs::path& survey : surveys) {
    fs::remove(survey, ignored);
  }
}

} // namespace inr
