// SPDX-License-Identifier: BSD-3-Clause
//
// Saving what comes from a raw file that becomes another, or none.
#include "MessageCapture.h"
#include "TestModels.h"
#include "WriterFixture.h"
#include "vtkINRWriter.h"

#include <vtkCallbackCommand.h>
#include <vtkImageReader.h>
#include <vtkNew.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <utility>
#include <vector>

namespace {

class RawFiles : public testing::Test
{
protected:
  RawFiles()
  {
    this->Writer->SetFileName(this->path().c_str());
    this->Writer->SetModelConfig(SmallModel);
    this->Writer->SetMaximumSteps(2);
  }

  std::string path() const { return this->Folder / "saved.inr"; }

  TemporaryFolder Folder;
  vtkNew<vtkINRWriter> Writer;
};

/// 1,100 bytes and their reader.
vtkSmartPointer<vtkImageReader> SmallRaw(const std::string& path)
{
  std::string bytes(1100, 'x');
  bytes[500] = 'y';
  std::ofstream(path) << bytes;
  auto reader = vtkSmartPointer<vtkImageReader>::New();
  reader->SetFileName(path.c_str());
  reader->SetFileDimensionality(3);
  reader->SetDataExtent(0, 9, 0, 9, 0, 10);
  reader->SetDataScalarTypeToUnsignedChar();
  return reader;
}

/// 320 x 320 x 160 floats between -1 and 1, others for each number of waves.
void WriteWaves(const std::string& path, int waves)
{
  std::vector<float> layer(std::size_t{320} * 320);
  std::ofstream file(path, std::ios::binary);
  for (int z = 0; z < 160; ++z) {
    for (std::size_t k = 0; k < layer.size(); ++k) {
      layer[k] = std::sin(0.02f * static_cast<float>(waves * static_cast<int>(k % 320) + z));
    }
    file.write(reinterpret_cast<const char*>(layer.data()),
               static_cast<std::streamsize>(layer.size() * sizeof(float)));
  }
}

/// `act` gets the progress text.
void OnProgress(vtkAlgorithm* algorithm, std::function<void(const std::string&)> act)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(new std::function<void(const std::string&)>(std::move(act)));
  command->SetClientDataDeleteCallback(
      [](void* data) { delete static_cast<std::function<void(const std::string&)>*>(data); });
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const char* text = static_cast<vtkAlgorithm*>(caller)->GetProgressText();
    (*static_cast<std::function<void(const std::string&)>*>(data))(text ? text : "");
  });
  algorithm->AddObserver(vtkCommand::ProgressEvent, command);
}

} // namespace

// ParaView's reader of raw files would try for ever.
TEST_F(RawFiles, AreRefusedWhereTooShortOrGone)
{
  const std::string path = this->Folder / "short.raw";
  const vtkSmartPointer<vtkImageReader> reader = SmallRaw(path);
  std::filesystem::resize_file(path, 1000);
  this->Writer->SetInputConnection(reader->GetOutputPort());
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_NE(messages.text().find("has 1000 bytes"), std::string::npos) << messages.text();
  EXPECT_NE(messages.text().find("ask for 1100"), std::string::npos);
  std::filesystem::remove(path);
  reader->Modified();
  this->Writer->Write();
  EXPECT_NE(messages.text().find("cannot be opened"), std::string::npos) << messages.text();
  EXPECT_NE(this->Writer->GetErrorCode(), 0u);
  EXPECT_FALSE(std::filesystem::exists(this->path()));
}

// Nobody has to look at it again.
TEST_F(RawFiles, AreNotNeededOnceTheyAreInMemory)
{
  const std::string path = this->Folder / "short.raw";
  const vtkSmartPointer<vtkImageReader> reader = SmallRaw(path);
  this->Writer->SetInputConnection(reader->GetOutputPort());
  reader->Update();
  for (const bool gone : {false, true}) {
    gone ? static_cast<void>(std::filesystem::remove(path)) : std::filesystem::resize_file(path, 3);
    std::filesystem::remove(this->path());
    const MessageCapture messages;
    this->Writer->Write();
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    EXPECT_TRUE(std::filesystem::exists(this->path()));
  }
  std::filesystem::create_directory(path);
  reader->Modified();
  const MessageCapture messages;
  this->Writer->Write();
  EXPECT_NE(messages.text().find("'" + path + "' cannot be opened"), std::string::npos)
      << messages.text();
  EXPECT_NE(this->Writer->GetErrorCode(), 0u);
}

// What is read in pieces is read again while it trains, and after.
TEST_F(RawFiles, AreNamedWhenTheyChangeWhileTheyAreRead)
{
  const std::string path = this->Folder / "large.raw";
  const auto removed = [&] { std::filesystem::remove(path); };
  const auto cut = [&] { std::filesystem::resize_file(path, 1 << 20); };
  const auto replaced = [&] {
    WriteWaves(path + ".new", 3), std::filesystem::rename(path + ".new", path);
  };
  const std::vector<std::pair<std::function<void()>, std::string>> changes = {
      {removed, "'" + path + "' cannot be opened"},
      {cut, "'" + path + "' has 1048576 bytes"},
      {replaced, "'" + path + "' has been replaced or written to"}};
  for (const auto& [change, words] : changes) {
    WriteWaves(path, 1);
    vtkNew<vtkImageReader> reader;
    reader->SetFileName(path.c_str());
    reader->SetFileDimensionality(3);
    reader->SetDataExtent(0, 319, 0, 319, 0, 159);
    reader->SetDataScalarTypeToFloat();
    reader->SetDataByteOrderToLittleEndian();
    vtkNew<vtkINRWriter> writer;
    writer->SetInputConnection(reader->GetOutputPort());
    writer->SetFileName(this->path().c_str());
    writer->SetModelConfig(SmallModel);
    writer->SetMaximumSteps(60);
    writer->SetMemoryLimit(120);
    writer->SetCheckpointInterval(0);
    bool done = false;
    OnProgress(writer, [&](const std::string& text) {
      if (text.rfind("Training", 0) == 0 && !std::exchange(done, true)) {
        change();
      }
    });
    const MessageCapture messages;
    writer->Write();
    EXPECT_TRUE(done);
    EXPECT_NE(messages.text().find(words), std::string::npos) << messages.text();
    EXPECT_FALSE(std::filesystem::exists(this->path()));
  }
}
