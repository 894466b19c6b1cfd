// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRWriter
 * @brief trains an implicit neural representation of image data and saves it as a model file
 *
 * The point array to save is chosen with SetInputArrayToProcess (default: the active scalars, or
 * the only array; vtkGhostType and vtkValidPointMask do not count); it has one component of any
 * number type. Training ends when TargetPSNR is reached, after MaximumSteps or after TimeLimit,
 * whichever comes first. With the same seed, steps and kernel family the result is the same on any
 * number of threads; where TimeLimit ended it, or seemed to allow clearly less than MaximumSteps,
 * with the same PlannedSteps, too.
 *
 * With WriteTimeSteps each time step of the input goes into a file of its own, which tells its
 * time, and is trained from the parameters of the one before.
 *
 * NaNs and infinities are left out: they are no targets, count neither in the range nor in the
 * quality, and are reported with a warning; where they were, the file holds a smooth continuation.
 *
 * Progress events tell the truth. AbortExecute, SIGINT and SIGTERM stop the training; then, as
 * after any error, no model file is left behind, but a checkpoint (FileName + ".checkpoint"), from
 * which the next Write of the same data with the same settings goes on to the same model (with
 * VTK 9.2, call SetAbortExecute(0) before). A signal that comes while a source reads counts when
 * that has come back; a second one ends the process. So it does after the process was killed, from
 * the checkpoint that was written before. When the model is written, the checkpoint is removed.
 */
#ifndef vtkINRWriter_h
#define vtkINRWriter_h

#include "Common/VTKCompat.h"    // for what writers override
#include "vtkINRReadersModule.h" // for export macro

#include <vtkWriter.h>

#include <cstdint>    // for byte counts
#include <functional> // for observers
#include <limits>     // for infinity, which Write refuses
#include <memory>     // for Internals
#include <string>     // for messages
#include <vector>     // for time steps

class ControllerGroup;
class StopSignals;
class TrainingBackend;
class vtkMultiProcessController;
struct ParallelInput;
struct TrainingInput;
namespace inr {
class TrainingAccelerator;
struct Model;
struct TrainingOptions;
struct TrainingProgress;
struct VolumeInfo;
} // namespace inr

class VTKINRREADERS_EXPORT vtkINRWriter : public vtkWriter
{
public:
  static vtkINRWriter* New();
  vtkTypeMacro(vtkINRWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The model file to write.
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /// Stop at this peak signal-to-noise ratio in dB, as estimated on random voxels every 200 steps;
  /// the file's may differ by some hundredths, or more where TargetRatio is set, too, and of
  /// localised data, above all where they are read in pieces or shared out to processes. A warning
  /// tells of a file that is 0.1 dB below or more. 0 (default) = no target.
  vtkSetClampMacro(TargetPSNR, double, 0, std::numeric_limits<double>::infinity());
  vtkGetMacro(TargetPSNR, double);
  ///@}

  ///@{
  /// Choose a model whose file is this many times smaller than the data, or somewhat more, down to
  /// a file of a few KiB, or more with small macro-cells; a warning says where it is too large. 0
  /// (default) = by the volume's size.
  vtkSetClampMacro(TargetRatio, double, 0, std::numeric_limits<double>::infinity());
  vtkGetMacro(TargetRatio, double);
  ///@}

  ///@{
  /// Stop after so many steps of 16,384 samples; 0 (default) = no limit.
  vtkSetClampMacro(MaximumSteps, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(MaximumSteps, vtkIdType);
  ///@}

  ///@{
  /// Stop training after so many seconds, within a step if need be; 0 = no limit. Default 300.
  ///
  /// Neither of what comes before, the first reading of an input that is read in pieces, which
  /// gives the range of values, nor of what comes after, packing (as long as decoding two to ten
  /// million voxels, and a third of a second per million parameters) and measuring the quality,
  /// which takes as long as decoding all the voxels: without them the file would be wrong about its
  /// data, and how much time to leave for them nobody knows beforehand. So the same limit gives the
  /// same quality, wherever the data come from; AbortExecute and signals end them, too.
  vtkSetClampMacro(TimeLimit, double, 0, std::numeric_limits<double>::infinity());
  vtkGetMacro(TimeLimit, double);
  ///@}

  ///@{
  /// Seconds of training between two checkpoints, which take 14 bytes per parameter and, of an
  /// input that is read in pieces, its samples: 512 MiB at most, and 16 bytes per macro-cell. Each
  /// of several processes writes its samples once, to a file of its own (FileName +
  /// ".checkpoint.rank" and its number), if reading all took longer than that. The distance grows
  /// where writing takes more than a twentieth of the time. 0 = none. Default 60.
  vtkSetClampMacro(CheckpointInterval, double, 0, VTK_DOUBLE_MAX);
  vtkGetMacro(CheckpointInterval, double);
  ///@}

  ///@{
  /// Go on from a checkpoint that is there, if it is of the same training; if not, a warning says
  /// what differs. Steps, TrainingSeconds and TimeLimit count what was before. Default on.
  vtkSetMacro(Resume, bool);
  vtkGetMacro(Resume, bool);
  vtkBooleanMacro(Resume, bool);
  ///@}

  ///@{
  /// MiB for an input that is not in memory yet, and its training. What would fill more than half
  /// of it is never read as a whole but in pieces, two or three times (more through filters that
  /// need neighbours), and the default model is made to fit; a warning says where that made it
  /// smaller. An input that is in memory, or fits, is trained as a whole by a model of any size,
  /// which the limit does not change. Sources often do not tell of all their arrays: where four
  /// times of what one tells would fill more than half of the limit, it is asked for one voxel
  /// first. 0 (default) = half of the machine's memory, or of what a batch system or container lets
  /// the process have of it. Several processes share it on each machine.
  ///
  ///     writer = servermanager.writers.INRWriter(Input=source, FileName="model.inr",
  ///                                              MemoryLimit=1024)
  ///     writer.UpdatePipeline()
  ///
  /// takes data of any size in pvpython or pvbatch, as long as nothing updates or shows `source`;
  /// SaveData would, before it came to the writer.
  vtkSetClampMacro(MemoryLimit, int, 0, VTK_INT_MAX);
  vtkGetMacro(MemoryLimit, int);
  ///@}

  ///@{
  /// Edge of the macro-cells in voxels, a power of two up to 2^29; 0 (default) = the smallest power
  /// of two from 16 that gives at most 2^22 cells.
  vtkSetClampMacro(MacroCellSize, int, 0, VTK_INT_MAX);
  vtkGetMacro(MacroCellSize, int);
  ///@}

  ///@{
  /// Steps that the learning rate is spread over; 0 (default) = MaximumSteps or, without it, 10,000
  /// to a TargetPSNR; but what the first steps show that TimeLimit allows, where that is clearly
  /// less or neither is set. To repeat a training that TimeLimit ended: its file says
  /// `planned_steps` and `steps` (MaximumSteps).
  vtkSetClampMacro(PlannedSteps, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(PlannedSteps, vtkIdType);
  ///@}

  ///@{
  /// Write all time steps of the input, each into its own file, instead of the present one.
  /// TimeLimit, MaximumSteps and targets are for each of them. Default off.
  vtkSetMacro(WriteTimeSteps, bool);
  vtkGetMacro(WriteTimeSteps, bool);
  vtkBooleanMacro(WriteTimeSteps, bool);
  ///@}

  ///@{
  /// What WriteTimeSteps puts between the file's name and its extension, with %d, or %.3d for at
  /// least three digits, for the number of the step. Default "_%d".
  vtkSetStringMacro(FileNameSuffix);
  vtkGetStringMacro(FileNameSuffix);
  ///@}

  ///@{
  /// The first and the last of the steps that WriteTimeSteps writes, and their distance, by number.
  /// Default: from 0 to the end (a last one before the first), each.
  vtkSetClampMacro(MinTimeStep, int, 0, VTK_INT_MAX);
  vtkGetMacro(MinTimeStep, int);
  vtkSetMacro(MaxTimeStep, int);
  vtkGetMacro(MaxTimeStep, int);
  vtkSetClampMacro(TimeStepStride, int, 1, VTK_INT_MAX);
  vtkGetMacro(TimeStepStride, int);
  ///@}

  ///@{
  /// Start the training of a time step from the parameters of the latest one that this writer has
  /// trained before, where the model is of the same size and says something of the data: that of
  /// WriteTimeSteps, or of an earlier Write of data that tell another time. Constant data take no
  /// training. Default on.
  vtkSetMacro(StartFromPrevious, bool);
  vtkGetMacro(StartFromPrevious, bool);
  vtkBooleanMacro(StartFromPrevious, bool);
  ///@}

  ///@{
  /// Start of the random numbers. Default 1.
  vtkSetClampMacro(Seed, int, 0, VTK_INT_MAX);
  vtkGetMacro(Seed, int);
  ///@}

  enum Backends {
    AUTO = 0, ///< an NVIDIA GPU where one can be used, else the CPU
    CPU = 1,
    CUDA = 2 ///< the same as AUTO, and a warning says why where none can be used
  };
  ///@{
  /// What trains; one of Backends, anything else is refused. A GPU takes the volume into its memory
  /// where there is room for it; else samples are drawn in the host's memory, or from what is read
  /// in pieces, while it computes. It trains in float32, to the CPU's parameters but for rounding
  /// and the order of sums; its first step is compared with the CPU's. One that fails, at whatever
  /// time, is given up with a warning, and the CPU goes on from a copy of an earlier step: 200
  /// steps old at most or, where copies are slow, as old as fifty of them take. So is one whose
  /// memory is short, of which AUTO says nothing. Each Write tries it again. Several processes
  /// train on the CPU. Default AUTO.
  void SetBackend(int backend);
  vtkGetMacro(Backend, int);
  ///@}

  /// What trained in the last Write, and where its samples came from: "CPU avx2; volume in host
  /// memory", "CUDA float32, NVIDIA H200; volume in device memory". Empty before.
  const char* GetBackendInUse() const { return this->BackendInUse.c_str(); }

  ///@{
  /// The model as tiny-cuda-nn configuration (JSON text with "encoding" and "network", in which
  /// unknown keys are refused); overrides TargetRatio. Empty (default) = chosen.
  vtkSetStringMacro(ModelConfig);
  vtkGetStringMacro(ModelConfig);
  ///@}

  ///@{
  /// Write a file that instantvnr and cINR read, too, and that is two to six times as large for
  /// the same model. Off (default): a compact file, which loses about 0.1 dB, but more where
  /// TargetRatio takes it, or of localised data that are read in pieces.
  ///
  ///     SaveData("model.inr", proxy=volume, ReadableByInstantVNR=1)
  vtkSetMacro(ReadableByInstantVNR, bool);
  vtkGetMacro(ReadableByInstantVNR, bool);
  vtkBooleanMacro(ReadableByInstantVNR, bool);
  ///@}

  ///@{
  /// The processes that train together, each on the piece of the image that it holds, where there
  /// are several: n processes give the model of one whose mini-batches are n times as large. All of
  /// them call Write; the first one writes the file. Where pieces would fill more than half of
  /// MemoryLimit, each process reads a share of the volume piece by piece, as often as the others
  /// and at the same time. Default: the global controller; null = this process alone.
  void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController();
  ///@}

  ///@{
  /// What the last Write achieved: quality against the data (PSNR in dB, infinite when exact; see
  /// vtkINRReader), bytes of the data over bytes of the file, steps and seconds of training. 0
  /// before.
  vtkGetMacro(PSNR, double);
  vtkGetMacro(SSIM, double);
  vtkGetMacro(MaximumError, double);
  vtkGetMacro(Ratio, double);
  vtkGetMacro(Steps, vtkIdType);
  vtkGetMacro(TrainingSeconds, double);
  /// Of TrainingSeconds, since the training began or went on: in which this process waited for
  /// the gradients of the others, and in which they told each other theirs.
  vtkGetMacro(WaitingSeconds, double);
  vtkGetMacro(ExchangeSeconds, double);
  ///@}

  /// Is an array of this name (may be null) one that tells where others have no values? For other
  /// libraries, which share nothing but classes.
  static bool IsMask(const char* name);

  /// 1, or 0 after an error. What is read is looked at before.
  int Write() override;

protected:
  vtkINRWriter();
  ~vtkINRWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(vtkInformation*, vtkInformationVector**,
                             vtkInformationVector*) override;
  void WriteData() override;

  /// What may train beside the CPU; null where there is none, with the reason.
  virtual std::shared_ptr<const inr::TrainingAccelerator>
  FindTrainingAccelerator(std::string& reason);

#ifdef INR_VTK_WRITERS_RETURN
  /// The error code tells; with false, the pipeline would add a message to ours.
  bool WriteDataAndReturn() override
  {
    this->WriteData();
    return true;
  }
#endif

private:
  vtkINRWriter(const vtkINRWriter&) = delete;
  void operator=(const vtkINRWriter&) = delete;

  class Internals;

  void WriteStep();
  void RequireOfAll(bool succeeded);
  void RequireSameSteps();
  void Attempt(const std::function<void()>& act);
  bool CheckFiles(const std::vector<int>& steps);
  void PlanSteps(vtkInformation* input);
  void WriteInput(const StopSignals& signals);
  TrainingInput FindInput(vtkDataObject* data);
  std::int64_t MemoryLimitInBytes() const;
  inr::TrainingOptions MakeOptions() const;
  void WarnOfWhole(const std::string& why);
  void WarnOfLargeFile(const inr::Model& model);
  void WarnOfSmallModel(const inr::Model& model, const inr::TrainingOptions& options);
  /// `showsHidden`: of any process; see TrainingInput.
  void WarnOfModel(const inr::Model& model, const inr::TrainingOptions& options, bool showsHidden);
  std::shared_ptr<const inr::Model>
  TrainAsRead(const ParallelInput& given, const inr::TrainingOptions& options,
              const ControllerGroup& group,
              const std::function<bool(const inr::TrainingProgress&)>& observe);
  std::shared_ptr<const inr::Model>
  TrainInPieces(const TrainingInput& first, const inr::TrainingOptions& options,
                const ControllerGroup& group,
                const std::function<bool(const inr::TrainingProgress&)>& observe);
  std::shared_ptr<const inr::Model> FindStart(const inr::VolumeInfo& volume) const;
  void Train(const ParallelInput& input, const StopSignals& signals, const ControllerGroup& group);
  std::shared_ptr<TrainingBackend> FindBackend();
  void BeginFile();
  void KeepResult(const inr::Model& model, vtkIdType fileSize);

  int Backend = AUTO;
  std::string BackendInUse;
  char* FileName = nullptr;
  double TargetPSNR = 0;
  double TargetRatio = 0;
  vtkIdType MaximumSteps = 0;
  vtkIdType PlannedSteps = 0;
  double TimeLimit = 300;
  double CheckpointInterval = 60;
  bool Resume = true;
  int MemoryLimit = 0;
  int MacroCellSize = 0;
  int Seed = 1;
  char* ModelConfig = nullptr;
  bool ReadableByInstantVNR = false;
  bool WriteTimeSteps = false;
  char* FileNameSuffix = nullptr;
  int MinTimeStep = 0;
  int MaxTimeStep = -1;
  int TimeStepStride = 1;
  bool StartFromPrevious = true;

  double PSNR = 0;
  double SSIM = 0;
  double MaximumError = 0;
  double Ratio = 0;
  vtkIdType Steps = 0;
  double TrainingSeconds = 0;
  double WaitingSeconds = 0;
  double ExchangeSeconds = 0;

  std::unique_ptr<Internals> Internal;
};

#endif
