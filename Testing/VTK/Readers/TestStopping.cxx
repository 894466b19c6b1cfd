// SPDX-License-Identifier: BSD-3-Clause
// A writer's progress, and how it is stopped and goes on.
#include "WriterFixture.h"

#include <vtkCallbackCommand.h>

#include <csignal>
#include <filesystem>

namespace {

struct ProgressWatcher
{
  int calls = 0;
  double last = 0;
  bool rising = true;
  bool named = true;
  int stopAfter = VTK_INT_MAX;

  static void Watch(vtkObject* caller, unsigned long, void* data, void*)
  {
    auto* self = static_cast<ProgressWatcher*>(data);
    auto* writer = vtkAlgorithm::SafeDownCast(caller);
    self->rising = self->rising && writer->GetProgress() >= self->last;
    self->last = writer->GetProgress();
    // The pipeline reports beginning and end by itself.
    const bool within = self->last > 0.0 && self->last < 1.0;
    self->named = self->named && (!within || writer->GetProgressText());
    if (++self->calls >= self->stopAfter) {
      writer->SetAbortExecute(1);
    }
  }
};

} // namespace

TEST_F(Writer, ReportsProgressAndStopsWhenAsked)
{
  ProgressWatcher watcher;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&watcher);
  command->SetCallback(ProgressWatcher::Watch);
  this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);

  const auto image = MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1);
  this->write(image);
  EXPECT_GE(watcher.calls, 2);
  EXPECT_TRUE(watcher.rising);
  EXPECT_TRUE(watcher.named);
  EXPECT_EQ(watcher.last, 1.0);
  std::filesystem::remove(this->path());

  watcher = ProgressWatcher();
  watcher.stopAfter = 2;
  this->Algorithm->SetCheckpointInterval(0);
  this->Algorithm->SetMaximumSteps(0); // five minutes
  this->expectRefusal(image, "stopped");

  watcher = ProgressWatcher();
  this->Algorithm->SetAbortExecute(0); // VTK 9.1 does it by itself, 9.2 leaves it to the caller
  this->Algorithm->SetMaximumSteps(80);
  this->write(image);
  EXPECT_EQ(this->Folder.entries(), 1);
}

namespace {

/// Stops a writer once its progress is beyond `limit`.
struct Stopper
{
  explicit Stopper(vtkAlgorithm* writer) : Writer(writer)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
      auto* algorithm = vtkAlgorithm::SafeDownCast(caller);
      if (algorithm->GetProgress() > static_cast<Stopper*>(data)->limit) {
        algorithm->SetAbortExecute(1);
      }
    });
    writer->AddObserver(vtkCommand::ProgressEvent, this->Command);
  }
  ~Stopper()
  {
    this->Writer->RemoveObserver(this->Command);
    this->Writer->SetAbortExecute(0);
  }
  Stopper(const Stopper&) = delete;
  Stopper& operator=(const Stopper&) = delete;

  double limit = 0.4;
  vtkAlgorithm* Writer;
  vtkNew<vtkCallbackCommand> Command;
};

} // namespace

TEST_F(Writer, GoesOnFromTheCheckpointOfAStoppedTraining)
{
  const auto image = MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1);
  this->write(image);
  const inr::ModelPointer whole = inr::ReadModel(this->path());
  std::filesystem::remove(this->path());

  const std::string checkpoint = this->path() + ".checkpoint";
  {
    const MessageCapture messages;
    const Stopper stopper(this->Algorithm);
    this->write(image);
    EXPECT_TRUE(messages.onlyError("steps are kept in '" + checkpoint)) << messages.text();
  }
  EXPECT_EQ(this->Folder.entries(), 1);
  EXPECT_TRUE(std::filesystem::exists(checkpoint));
  {
    const MessageCapture messages;
    this->Algorithm->SetSeed(2);
    this->write(image);
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    ASSERT_EQ(messages.warnings().size(), 1u);
    EXPECT_NE(messages.warnings()[0].find("Seed is 1 there and 2 here"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(checkpoint)); // it may still be wanted
  }
  const MessageCapture messages;
  this->Algorithm->SetSeed(1);
  this->write(image);
  EXPECT_TRUE(messages.errors().empty() && messages.warnings().empty()) << messages.text();
  EXPECT_EQ(this->Algorithm->GetSteps(), 80);
  EXPECT_EQ(inr::ReadModel(this->path())->parameters, whole->parameters);
  EXPECT_EQ(this->Folder.entries(), 1);
}

TEST_F(Writer, GoesOnWithMeasuringWhenItWasStoppedThere)
{
  const auto image = MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1);
  this->Algorithm->SetCheckpointInterval(1e-3);
  {
    const MessageCapture messages;
    Stopper stopper(this->Algorithm);
    stopper.limit = 0.9;
    this->write(image);
    EXPECT_TRUE(messages.onlyError("; its 80 steps are kept in ")) << messages.text();
  }
  vtkIdType trained = 0;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&trained);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const char* text = vtkAlgorithm::SafeDownCast(caller)->GetProgressText();
    *static_cast<vtkIdType*>(data) += text && std::string(text) == "Training INR" ? 1 : 0;
  });
  this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  this->write(image);
  EXPECT_LE(trained, 1); // the pipeline's own report keeps the text
  EXPECT_EQ(this->Algorithm->GetSteps(), 80);
  EXPECT_EQ(this->Folder.entries(), 1);
}

namespace {

volatile std::sig_atomic_t SignalsSeen = 0;
volatile std::sig_atomic_t MessagesBefore = 0;

/// As in pvpython, where the handler ends the process: what is to be said must have been.
void NoteSignal(int)
{
  SignalsSeen = SignalsSeen + 1;
  const auto* window = dynamic_cast<CapturingWindow*>(vtkOutputWindow::GetInstance());
  MessagesBefore = window ? static_cast<int>(window->Errors.size()) : 0;
}

} // namespace

TEST_F(Writer, StopsOnASignalAndHandsItOn)
{
  struct sigaction mine = {};
  struct sigaction before = {};
  mine.sa_handler = NoteSignal;
  sigaction(SIGTERM, &mine, &before);

  bool sent = false;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&sent);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const bool training = vtkAlgorithm::SafeDownCast(caller)->GetProgressText();
    if (training && !*static_cast<bool*>(data)) {
      *static_cast<bool*>(data) = true;
      std::raise(SIGTERM);
      EXPECT_EQ(SignalsSeen, 0); // not yet: first the training ends in good order
    }
  });
  const unsigned long tag = this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  this->Algorithm->SetCheckpointInterval(0);
  this->Algorithm->SetMaximumSteps(0);
  this->expectRefusal(MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1), "stopped");
  EXPECT_EQ(SignalsSeen, 1);
  EXPECT_EQ(MessagesBefore, 1);
  this->Algorithm->RemoveObserver(tag);

  std::raise(SIGTERM); // the handler is back in its place
  EXPECT_EQ(SignalsSeen, 2);
  sigaction(SIGTERM, &before, nullptr);
}

namespace {

/// Takes a folder away as soon as there is a checkpoint in it.
struct Remover
{
  std::filesystem::path folder;
  std::filesystem::path checkpoint;

  static void Watch(vtkObject*, unsigned long, void* data, void*)
  {
    const auto* self = static_cast<Remover*>(data);
    if (std::filesystem::exists(self->checkpoint)) {
      std::filesystem::remove_all(self->folder);
    }
  }
};

} // namespace

TEST_F(Writer, DoesNotPointToACheckpointThatIsGone)
{
  const std::filesystem::path folder(this->Folder / "folder");
  const std::string model = (folder / "saved.inr").string();
  std::filesystem::create_directory(folder);
  Remover remover{folder, model + ".checkpoint"};
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&remover);
  command->SetCallback(Remover::Watch);
  this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  this->Algorithm->SetFileName(model.c_str());
  this->Algorithm->SetCheckpointInterval(0.01);
  this->Algorithm->SetMaximumSteps(1000);

  const MessageCapture messages;
  this->write(MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1));
  EXPECT_FALSE(std::filesystem::exists(folder)) << "there was no checkpoint";
  EXPECT_TRUE(messages.onlyError("No such file or directory")) << messages.text();
  EXPECT_EQ(messages.text().find("is kept"), std::string::npos) << messages.text();
}
