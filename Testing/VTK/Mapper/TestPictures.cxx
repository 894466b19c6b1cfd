// SPDX-License-Identifier: BSD-3-Clause
// Every scene is compared with a baseline picture and, independently, with VTK's own volume
// rendering of the same model's voxels: geometry, half-voxel convention and opacity correction must
// agree for that.
#include "Core/Image/Metrics.h"
#include "TestModel.h"
#include "TestScene.h"
#include "vtkINRVolumeMapper.h"

#include <vtkImageData.h>

#include <gtest/gtest.h>

namespace {

class Pictures : public testing::TestWithParam<test::SceneCase>
{
protected:
  inr::ModelPointer model() const
  {
    return this->GetParam().oblique ? test::MakeOblique() : test::MakeModel();
  }

  inr::Image picture() const
  {
    const std::string file = test::Write(*this->model(), this->GetParam().name + ".inr");
    test::Scene scene;
    this->GetParam().make(scene, [&] { return test::InrMapper(file); });
    return scene.capture();
  }

  inr::Image voxelPicture() const
  {
    const vtkSmartPointer<vtkImageData> voxels = test::Decode(this->model());
    test::Scene scene;
    this->GetParam().make(scene, [&] { return test::VoxelMapper(voxels); });
    return scene.capture();
  }

  std::string output(const std::string& suffix) const
  {
    return std::string(INR_TEST_OUTPUT) + "/" + this->GetParam().name + suffix;
  }
};

TEST_P(Pictures, EqualTheirBaseline)
{
  const inr::Image drawn = this->picture();
  test::WritePng(this->output(".png"), drawn);
  const inr::Image baseline =
      test::ReadPng(std::string(INR_TEST_BASELINES) + "/Mapper" + this->GetParam().name + ".png");
  EXPECT_GT(inr::ImageSsim(drawn, baseline), 0.99) << "see " << this->output(".png");
  // SSIM hardly sees a change of all colours.
  EXPECT_GT(inr::ImagePsnr(drawn, baseline), 40.0) << "see " << this->output(".png");
}

TEST_P(Pictures, AgreeWithVtkOnTheVoxels)
{
  if (!this->GetParam().comparable) {
    GTEST_SKIP() << "VTK draws it otherwise, see SceneCase";
  }
  const inr::Image drawn = this->picture();
  const inr::Image voxels = this->voxelPicture();
  test::WritePng(this->output("-voxels.png"), voxels);
  EXPECT_GT(inr::ImagePsnr(drawn, voxels), 29.0) << "see " << this->output("-voxels.png");
}

INSTANTIATE_TEST_SUITE_P(Mapper, Pictures, testing::ValuesIn(test::SceneCases()),
                         [](const auto& info) { return info.param.name; });

} // namespace
