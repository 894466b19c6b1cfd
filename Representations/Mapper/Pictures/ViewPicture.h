// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Render/Scene/Frame.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Representations/Mapper/Pictures/PictureKey.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace inr {

/// The number of all pictures that no view's next one goes on with.
constexpr int NobodysPicture = -1;

/// The last picture made and what it took; without pixels when nothing was drawn.
struct PaintedFrame
{
  Image rgba;
  Image depth;
  Image samples; ///< empty unless asked for and known
  FrameStatistics statistics;
  std::string backend; ///< see vtkINRVolumeMapper::GetBackendInUse
  double seconds = 0;  ///< from the mapper's call to the blended picture
  int reduction = 0;   ///< viewport size / image size
  bool depthRead = false;
  bool converged = false; ///< shown, and complete
};

/// What to tell a picture by, without the pixels of what else there is.
struct DepictedScene
{
  const Frame& frame; ///< without size and surroundings
  std::int64_t colors;
  std::uint64_t surroundings; ///< when they changed last
};

/// What a view shows of a volume. A picture that is complete is not made again while everything
/// stays as it is: windows are drawn anew for many reasons.
///
/// For each picture: begin(), then showAgain() and, where that finds none, the drawing into last()
/// and finish() if it is complete; then depict(). Of one that was not drawn, last() is empty.
class ViewPicture
{
public:
  /// `number`: see Frame::view.
  explicit ViewPicture(int number) : Number(number) {}
  ViewPicture(const ViewPicture&) = delete;
  ViewPicture& operator=(const ViewPicture&) = delete;

  int number() const { return this->Number; }
  PaintedFrame& last() { return this->Last; }
  const PaintedFrame& last() const { return this->Last; }

  /// Before a picture is made: there is none until then.
  void begin();
  /// Shows the one from before it began, if that is what `frame` asks for. The rest is as for
  /// PictureKey.
  bool showAgain(const Frame& frame, bool countsSamples, std::int64_t colors);
  /// That the picture is the one `frame` asks for, and is not to become any better.
  void finish(const Frame& frame, bool countsSamples, std::int64_t colors);
  /// What the picture is of.
  void depict(const DepictedScene& scene);
  /// Whether there is a picture, of just that.
  bool depicts(const DepictedScene& scene) const;
  /// For when everything has changed: it is a picture of nothing that there is.
  void outdate();

  /// One with fewer pixels, to be shown until there is something for all of this one's.
  ViewPicture& coarser();
  /// Shows that. What there is of this one is kept until the next one begins.
  void showCoarser();

  /// That the window be drawn again, to go on with this picture; and that this is being done.
  bool requested = false;
  bool goesOn = false;

private:
  int Number;
  PaintedFrame Last;
  std::optional<PaintedFrame> Fine; ///< the last picture made, where a coarser one is shown
  PaintedFrame Before;              ///< until there is another
  std::optional<PictureKey> Key;    ///< of what was drawn last, if it is complete
  std::optional<PictureKey> Scene;
  std::uint64_t Surroundings = 0;
  std::unique_ptr<ViewPicture> Coarser;
};

} // namespace inr
