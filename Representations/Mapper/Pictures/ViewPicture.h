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
/// For each picture: begin(), then showStill() or showAgain() and, where these find none, the
/// drawing into last() and finish() if it is complete; then depict(). Of one that was not drawn,
/// last() is empty.
///
/// A picture that passes, as one of a moving camera or one that is captured at another size, does
/// not end the view's own: that goes on when it is asked for again.
class ViewPicture
{
public:
  /// `number`: Frame::view, but of pictures that pass; not below NobodysPicture.
  explicit ViewPicture(int number) : Number(number) {}
  ViewPicture(const ViewPicture&) = delete;
  ViewPicture& operator=(const ViewPicture&) = delete;

  int number() const { return this->Number; }
  /// Frame::view of the picture that has begun: a view's that pass go on with each other.
  int frameView() const { return this->Passes ? NobodysPicture - 1 - this->Number : this->Number; }
  PaintedFrame& last() { return this->Last; }
  const PaintedFrame& last() const { return this->Last; }

  /// Whether the picture that has begun does.
  bool passes() const { return this->Passes; }
  /// Whether the view's own picture, if there is one, has so many pixels.
  bool hasSize(int width, int height) const;
  /// Before a picture is made, which `passes` or not: there is none until then.
  void begin(bool passes = false);
  /// In place of one that passes, the view's own, if that is of the same scene and size, in pixels,
  /// and shows something everywhere. It does not have to be complete.
  bool showStill(const DepictedScene& scene, int width, int height);
  /// Shows the one from before it began, if that is what `frame` asks for. The rest is as for
  /// PictureKey.
  bool showAgain(const Frame& frame, bool countsSamples, std::int64_t colors);
  /// That the picture is the one `frame` asks for, and is not to become any better.
  void finish(const Frame& frame, bool countsSamples, std::int64_t colors);
  /// What the picture is of.
  void depict(const DepictedScene& scene);
  /// Whether the view's picture from before was of that, whatever was around it.
  bool wasOfSame(const DepictedScene& scene) const;
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
  /// That what it shows will have changed again in a moment.
  bool hurried = false;

private:
  struct Depiction
  {
    explicit Depiction(const DepictedScene& scene);
    bool isOf(const DepictedScene& scene) const;
    bool isOf(const Frame& frame, std::int64_t colors) const;

    PictureKey key;
    std::uint64_t surroundings;
  };

  /// Makes the picture from before the last one.
  void takeBefore();

  int Number;
  PaintedFrame Last;
  std::optional<PaintedFrame> Fine; ///< the last picture made, where a coarser one is shown
  PaintedFrame Before;              ///< until there is another
  bool Passes = false;              ///< the last picture; the one before is the view's own
  std::optional<PictureKey> Key;    ///< of the view's own, if it is complete
  std::unique_ptr<Depiction> Scene; ///< of the last picture
  std::unique_ptr<Depiction> SceneBefore;
  std::unique_ptr<ViewPicture> Coarser;
};

} // namespace inr
