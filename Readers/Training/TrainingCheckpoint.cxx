// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/TrainingCheckpoint.h"

#include "Core/Training/Streaming/KeptSurvey.h"

#include <vtkLogger.h>
#include <vtkObject.h>
#include <vtkSetGet.h>

#include <filesystem>
#include <system_error>

TrainingCheckpoint::TrainingCheckpoint(vtkObject* writer, const std::string& target,
                                       double interval, bool resume)
    : Writer(writer), Path(interval > 0 ? target + ".checkpoint" : ""), Interval(interval),
      Resume(resume)
{}

inr::CheckpointOptions TrainingCheckpoint::options()
{
  inr::CheckpointOptions options;
  options.path = this->Path;
  options.interval = this->Interval;
  options.resume = this->Resume;
  options.tell = [this](inr::CheckpointEvent event, const std::string& text) {
    this->note(event, text);
  };
  return options;
}

void TrainingCheckpoint::note(inr::CheckpointEvent event, const std::string& text)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  if (event == inr::CheckpointEvent::Ignored || event == inr::CheckpointEvent::Failed) {
    this->Warnings.push_back(text);
    return;
  }
  if (event == inr::CheckpointEvent::SurveyKept) {
    this->HasSurvey = true;
    return;
  }
  this->Ours = true;
  if (event == inr::CheckpointEvent::Resumed) {
    this->News.push_back(text);
  }
}

void TrainingCheckpoint::tell()
{
  std::vector<std::string> news;
  std::vector<std::string> warnings;
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    news.swap(this->News);
    warnings.swap(this->Warnings);
  }
  for (const std::string& text : news) {
    vtkLog(INFO, << text);
  }
  for (const std::string& text : warnings) {
    vtkWarningWithObjectMacro(this->Writer, << text << ".");
  }
}

void TrainingCheckpoint::remove(int rank)
{
  std::error_code ignored; // they are of no harm
  if (this->Ours) {
    std::filesystem::remove(this->Path, ignored);
  }
  if (this->HasSurvey) {
    std::filesystem::remove(inr::SurveyPath(this->Path, rank), ignored);
  }
  if (rank == 0 && (this->Ours || this->HasSurvey)) {
    inr::RemoveSurveys(this->Path); // there may have been more processes, which were killed
  }
}

inr::Error TrainingCheckpoint::complete(const inr::Error& error)
{
  const std::string text = error.what();
  std::error_code unknown; // then it is taken to be there
  const bool isThere = std::filesystem::exists(this->Path, unknown) || unknown;
  // After a divergence the same would come again.
  if (!this->Ours || !isThere || error.code() == inr::ErrorCode::InvalidModel ||
      text.find(this->Path) != std::string::npos) {
    return error;
  }
  return inr::Error(error.code(),
                    text + "; '" + this->Path +
                        "' is kept, from where the same training goes on (with Resume = 0 it "
                        "begins anew)");
}
