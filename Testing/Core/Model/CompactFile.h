// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"
#include "Testing/Core/Model/TemporaryFolder.h"

/// A compact file, and what is to be said of bad ones.
struct CompactFile : testing::Test
{
  CompactFile() : Bytes(this->write(*CompactModel())) {}

  std::string path() const { return Folder.file("model.inr"); }

  std::string write(const inr::Model& model)
  {
    inr::WriteModel(model, this->path());
    return ReadBytes(this->path());
  }

  inr::ModelPointer roundTrip(const inr::Model& model)
  {
    this->write(model);
    return inr::ReadModel(this->path());
  }

  void expectUnwritable(const inr::Model& model, const std::string& words)
  {
    try {
      inr::WriteModel(model, this->path());
      ADD_FAILURE() << words << ": written";
    } catch (const inr::Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  void expectRefused(const std::string& bytes, const std::string& words)
  {
    WriteBytes(this->path(), bytes);
    try {
      inr::ReadModel(this->path());
      ADD_FAILURE() << words << ": accepted";
    } catch (const inr::Error& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(this->path()), std::string::npos) << message;
      EXPECT_NE(message.find(words), std::string::npos) << message;
    }
  }

  TemporaryFolder Folder;
  std::string Bytes;
};
