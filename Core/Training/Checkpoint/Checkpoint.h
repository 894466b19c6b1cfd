// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/InputFile.h"
#include "Core/Training/Runtime/StateArray.h"

#include <cstdint>
#include <map>
#include <string>

namespace inr {

/// What a training is of, by name ("seed" -> "1"): two with the same entries give the same
/// parameters after as many steps.
using TrainingIdentity = std::map<std::string, std::string>;

/// How far a training is, beside its arrays.
struct TrainingState
{
  std::uint64_t steps = 0;
  std::uint64_t plannedSteps = 0; ///< that the learning rate is spread over; 0 = no plan yet
  double seconds = 0;             ///< of training, in all processes that took part
  double psnr = 0;                ///< latest estimate in dB; 0 while there is none
  bool finished = false;          ///< a limit is reached, the result only has to be measured
  std::uint64_t anew = 0;         ///< times that it began anew, as the network was stuck
};

/// Writes a checkpoint through a temporary file and a rename: whenever the process ends, the file
/// is the old one or the new one. No copy of the arrays is made. `survey`: what a first reading of
/// the data has told, where it is worth keeping. Returns its size in bytes; throws
/// Error(CannotWrite).
///
/// All numbers are little-endian, all checksums CRC-32 as in zlib:
///
///     "INRtrain"            8 bytes
///     version               uint32, 1, or 2 with a survey
///     length of the header  uint32
///     header                JSON text: {"training": identity, "steps": ..., ...}; with a survey,
///                           "survey_bytes" and "training_bytes" say what its arrays and those
///                           behind them take, with all about them
///     checksum              uint32, of all bytes before
///     then for each array, those of the survey first
///     name                  8 bytes, zeros at the end
///     length of the array   uint64, bytes
///     array
///     checksum              uint32, of the array's bytes, its name and its length
std::int64_t WriteCheckpoint(const std::string& path, const TrainingIdentity& identity,
                             const TrainingState& state, const StateArrays& arrays,
                             const StateArrays& survey = {});

/// A checkpoint to go on from. All errors have the file's name in front.
class CheckpointFile
{
public:
  /// Reads all but the arrays. Throws Error(CannotRead), Error(Malformed) for what is no checkpoint
  /// or a broken one, Error(InvalidModel) for one whose header lacks something, Error(Unsupported)
  /// for one of a later version.
  explicit CheckpointFile(const std::string& path);

  const TrainingIdentity& identity() const { return this->Identity; }
  const TrainingState& state() const { return this->State; }

  /// Fills the arrays, once it has found them right. Throws Error(Malformed) when its
  /// arrays are others or broken; then nothing has changed.
  void load(const StateArrays& arrays) const;

  bool hasSurvey() const { return this->SurveyBytes > 0; }

  /// The same for the arrays of the survey.
  void loadSurvey(const StateArrays& survey) const;

private:
  void readHeader();
  void requireWhole() const;
  void readArrays(const StateArrays& arrays, std::int64_t at, bool keep) const;
  std::int64_t readArray(const std::string& front, std::int64_t at, char* to) const;

  std::string Path;
  InputFile File;
  std::int64_t FirstArray = 0; ///< byte
  std::int64_t SurveyBytes = 0;
  TrainingIdentity Identity;
  TrainingState State;
};

} // namespace inr
