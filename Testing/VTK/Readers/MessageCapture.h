// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

/// VTK's output window that keeps what it is told.
class CapturingWindow : public vtkOutputWindow
{
public:
  static CapturingWindow* New() { VTK_STANDARD_NEW_BODY(CapturingWindow); }
  vtkTypeMacro(CapturingWindow, vtkOutputWindow);

  void DisplayErrorText(const char* text) override { this->Errors.emplace_back(text); }
  void DisplayWarningText(const char* text) override { this->Warnings.emplace_back(text); }

  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
};

/// Catches every VTK error and warning of any object, the pipeline's included, while it lives.
class MessageCapture
{
public:
  MessageCapture() : Previous(vtkOutputWindow::GetInstance())
  {
    vtkOutputWindow::SetInstance(this->Window);
  }
  ~MessageCapture() { vtkOutputWindow::SetInstance(this->Previous); }
  MessageCapture(const MessageCapture&) = delete;
  MessageCapture& operator=(const MessageCapture&) = delete;

  const std::vector<std::string>& errors() const { return this->Window->Errors; }
  const std::vector<std::string>& warnings() const { return this->Window->Warnings; }

  /// Exactly one error, which contains `words`?
  bool onlyError(const std::string& words) const
  {
    return this->errors().size() == 1 && this->errors()[0].find(words) != std::string::npos;
  }

  std::string text() const
  {
    std::string all;
    for (const std::string& error : this->errors()) {
      all += error + "\n";
    }
    return all;
  }

private:
  vtkSmartPointer<vtkOutputWindow> Previous;
  vtkNew<CapturingWindow> Window;
};
