// SPDX-License-Identifier: BSD-3-Clause
//
// A simulation that hands its grid to ParaView's Catalyst, which saves it as model files: no voxel
// is ever written.
//
//   [mpirun -np N] example_catalyst pipeline.py [SIZE [STEPS]]
#include "GrayScott.h"

#include <vtkCPDataDescription.h>
#include <vtkCPInputDataDescription.h>
#include <vtkCPProcessor.h>
#include <vtkCPPythonPipeline.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

#include <cstdlib>
#include <iostream>
#include <mpi.h>

namespace {

constexpr const char* Channel = "grid"; // what the script calls it

// This process's part of the grid. The values stay where the simulation has them: VTK only reads
// them, and knows no constant arrays.
vtkNew<vtkImageData> MakeImage(const GrayScott& simulation)
{
  const int last = simulation.size() - 1;
  const int first = simulation.firstLayer();
  vtkNew<vtkImageData> image;
  image->SetExtent(0, last, 0, last, first, first + simulation.valueLayers() - 1);
  vtkNew<vtkDoubleArray> values;
  values->SetName("V");
  values->SetArray(const_cast<double*>(simulation.values()), image->GetNumberOfPoints(), 1);
  image->GetPointData()->SetScalars(values);
  return image;
}

// Counts the errors that ParaView reports. Catalyst knows of a script that raises, but not of an
// extractor that could not save.
class ReportedErrors
{
public:
  ReportedErrors()
      : Window(vtkOutputWindow::GetInstance()),
        Observer(this->Window->AddObserver(vtkCommand::ErrorEvent, this, &ReportedErrors::countOne))
  {}
  ~ReportedErrors() { this->Window->RemoveObserver(this->Observer); }
  ReportedErrors(const ReportedErrors&) = delete;
  ReportedErrors& operator=(const ReportedErrors&) = delete;

  bool none() const { return this->Count == 0; }

private:
  void countOne() { ++this->Count; }

  vtkSmartPointer<vtkOutputWindow> Window;
  unsigned long Observer;
  int Count = 0;
};

// Whether Catalyst could do what the script wants, as far as this process has been told.
bool HandOver(vtkCPProcessor* catalyst, const GrayScott& simulation, int step)
{
  vtkNew<vtkCPDataDescription> description;
  description->SetTimeData(step, step);
  description->AddInput(Channel);
  if (!catalyst->RequestDataDescription(description)) {
    return true; // the script wants nothing of this step
  }
  vtkCPInputDataDescription* const input = description->GetInputDescriptionByName(Channel);
  const int last = simulation.size() - 1;
  input->SetGrid(MakeImage(simulation));
  input->SetWholeExtent(0, last, 0, last, 0, last);
  const ReportedErrors errors;
  return catalyst->CoProcess(description) != 0 && errors.none();
}

int Run(const char* script, int size, int steps)
{
  int processes = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &processes);
  if (processes > size) {
    std::cerr << "There are more processes than the " << size << " layers to share\n";
    return 1;
  }
  vtkNew<vtkCPProcessor> catalyst;
  catalyst->Initialize();
  const auto pipeline = vtkCPPythonPipeline::CreateAndInitializePipeline(script, 2);
  if (!pipeline) {
    std::cerr << "Catalyst cannot use " << script << "\n";
    return 1;
  }
  catalyst->AddPipeline(pipeline);
  GrayScott simulation(size);
  int failed = 0;
  for (int step = 1; step <= steps; ++step) {
    simulation.step();
    failed += HandOver(catalyst, simulation, step) ? 0 : 1;
  }
  catalyst->Finalize();
  if (failed > 0) {
    std::cerr << "Catalyst failed in " << failed << (failed > 1 ? " steps\n" : " step\n");
  }
  return failed > 0 ? 1 : 0;
}

} // namespace

int main(int argc, char** argv)
{
  const int size = argc > 2 ? std::atoi(argv[2]) : 64;
  const int steps = argc > 3 ? std::atoi(argv[3]) : 2000;
  if (argc < 2 || argc > 4 || size < 8 || size > 1024 || steps < 1) {
    std::cerr << "usage: " << argv[0] << " pipeline.py [SIZE (8 to 1024) [STEPS]]\n";
    return 2;
  }
  MPI_Init(&argc, &argv);
  const int status = Run(argv[1], size, steps);
  MPI_Finalize();
  return status;
}
