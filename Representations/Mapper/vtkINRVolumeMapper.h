// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRVolumeMapper
 * @brief draws an implicit neural representation (INR) through a cache of decoded bricks
 *
 * The input is image data whose selected point scalars are a vtkINRDataArray, as vtkINRReader
 * gives them. The picture always shows the INR's native resolution, however coarse the grid is that
 * the reader presents, and no value of that grid is computed for it.
 *
 * Honoured: every camera (perspective, parallel, stereo, off-axis), tiles and viewports, the
 * volume's matrix, the image's origin, spacing and direction, opaque geometry (its depth buffer is
 * read only when a visible prop has opaque geometry or nothing is erased before), the mapper's
 * clipping planes and cropping regions, and from
 * vtkVolumeProperty the colour and scalar opacity functions of component 0, the
 * ScalarOpacityUnitDistance, a length in the volume's own space, whatever the volume's matrix makes
 * of it, and shading: ambient, diffuse, specular and
 * specular power by the renderer's lights. Interpolation type has no meaning here: an INR is
 * continuous.
 *
 * Blend modes: composite; the projections maximum, minimum and average intensity (of the values in
 * AverageIPScalarRange) and additive, unshaded, as VTK's GPU mapper has them; and isosurfaces, of
 * the volume property's values, with the opacity function's opacity and its shading, found between
 * two samples by bisection. What cannot change a picture is not looked at: no macro-cell whose
 * largest value is below one that a ray has met, none without an isosurface.
 *
 * Ordinary translucent surfaces are in their places in front of, inside and behind the volume,
 * whether the renderer peels them or not: up to 64 of them along a pixel's ray (fewer in windows of
 * more than 800,000 pixels: 25 in one of 1920 x 1080) are drawn once more to learn where they are,
 * which is done only when a visible prop has translucent geometry. Paths inside the volume do not
 * meet them: they throw no shadow on it; and projections, which have no depth, lie over all of
 * them.
 *
 * Several volumes in a renderer, each with a mapper of its own, are blended one after another, from
 * the furthest to the nearest, whatever their order there. Where they overlap they are not mixed;
 * the one whose middle is nearer to the camera lies over the other. Those in assemblies and in a
 * vtkLODProp3D come in the renderer's order. Of lights, VTK's diffuse colour counts, for all of
 * their light, on both sides.
 *
 * Refused with an error and not drawn: the blend mode slice, projections of a piece of the grid
 * (but see SetController) or by path tracing, paths cropped to what is no box, gradient opacity, 2D
 * transfer functions, masks, scalars that are not an INR. A message comes once, not at every frame.
 *
 * What rays meet is decoded brick by brick, at the level of resolution that the picture's pixels
 * deserve, and kept in a cache from frame to frame. A still frame waits until every sample is
 * there; it is the same whatever the size of the cache. When the render window asks for more than
 * 0.1 frames per second, a frame takes what the cache has, coarser levels where the wanted ones are
 * missing, and decodes more in the time that is left; and if even that is too slow, the picture is
 * computed at a half to a 64th of the window's width and height and stretched.
 *
 * Hardware selection finds the cells of the input where the opacity along a ray reaches one half
 * or, where it never does, half way through; no points. It looks at the picture that was drawn or,
 * where the scene has changed since, at one that it makes by ray marching, in the time that a still
 * picture has.
 *
 * Up to eight viewports, or eyes, go on with a picture of each by turns; of more, those of paths
 * begin anew each time. Of several windows the one that was drawn last is refined.
 *
 * Drawn by path tracing, the same medium scatters light: that of the renderer's lights
 * (directional, positional, spots, headlights and camera lights, with colour, intensity and
 * attenuation) and AmbientLight. A collision keeps the transfer function's colour times
 * ScatteringAlbedo of the light. The picture is the mean of SamplesPerPixel paths through each
 * pixel. Its alpha is the opacity along the pixel's ray up to the nearest opaque geometry, which
 * hides what is behind it but throws no shadow. A process that has a piece of the grid lights that
 * piece alone, unless SetController() says who has the others.
 */
#ifndef vtkINRVolumeMapper_h
#define vtkINRVolumeMapper_h

#include "vtkINRMapperModule.h" // for export macro

#include <vtkCommand.h> // for RefineEvent
#include <vtkVolumeMapper.h>

#include <memory> // for std::unique_ptr
#include <string> // for FindAccelerator
#include <vector> // for ProcessOrder

class vtkMultiProcessController;
class vtkRenderWindow;

namespace inr {
class Accelerator;
struct PaintSettings;
} // namespace inr

class VTKINRMAPPER_EXPORT vtkINRVolumeMapper : public vtkVolumeMapper
{
public:
  static vtkINRVolumeMapper* New();
  vtkTypeMacro(vtkINRVolumeMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum RenderModes { RAY_MARCHING = 0, PATH_TRACING = 1 };
  ///@{
  /** One of RenderModes. Default RAY_MARCHING. */
  vtkSetClampMacro(RenderMode, int, RAY_MARCHING, PATH_TRACING);
  vtkGetMacro(RenderMode, int);
  ///@}

  enum Backends {
    AUTO = 0, ///< an NVIDIA GPU where one can be used, else the CPU
    CPU = 1,
    CUDA = 2 ///< the same as AUTO, and a warning says why where none can be used
  };
  ///@{
  /**
   * What draws; one of Backends, anything else is refused. A GPU has the model, the cache (of all
   * volumes CacheSize at most, and half of its free memory), the rays and the paths; but of
   * pictures with an ErrorTolerance, of isosurfaces and PreIntegration where every sample asks the
   * network, and among more than 256 MiB of translucent surfaces, the CPU draws what the GPU
   * infers. Its values are float32, as the CPU's are, but for the order of summation.
   * One that fails, at whatever time, or draws another picture than the CPU, is given up for the
   * CPU with a warning, without change in a picture, until this is called again, if only with the
   * same. So is one whose memory is short, of which AUTO says nothing. A change empties the cache.
   * GetBackendInUse() says what is at work. Default AUTO.
   */
  void SetBackend(int backend);
  vtkGetMacro(Backend, int);
  ///@}

  ///@{
  /**
   * Of the processes on this machine that draw, which one this is, from 0 on, for them to share the
   * machine's GPUs. Default 0.
   */
  void SetLocalRank(int rank);
  vtkGetMacro(LocalRank, int);
  ///@}

  ///@{
  /**
   * Processes that each have a piece of one grid and a window of the same size. What they draw is
   * blended window by window, from the furthest piece to the nearest: composite blending, by rays.
   * Values that are projected and paths, which leave a piece for others, are no such pictures, and
   * isosurfaces would tear where pieces meet: of these each process draws a part of the picture, of
   * the whole volume and among the surfaces of all the windows, and the parts come together in the
   * window that lies over the others, of the first process in the order of drawing. Light that
   * would be more than white over a surface is limited: 8 bits overflow where windows are composed.
   * All processes must draw the same volumes with the same settings at the same time; they wait for
   * each other. A process that cannot draw its part says why, and nothing is drawn. Null or an
   * empty order, the default: projections of a piece are refused.
   */
  void SetController(vtkMultiProcessController* controller);
  void SetProcessOrder(const std::vector<int>& processes) { this->ProcessOrder = processes; }
  ///@}
  /**
   * Whether such processes draw parts of the picture whatever is blended: pieces are rounded to the
   * windows' 8 bits each; those of several volumes in different places, or of one whose axes are
   * not the world's, have no order in which the windows could be; and lights may make pieces too
   * bright to be composed. Default off.
   */
  void SetAlwaysTogether(bool on) { this->AlwaysTogether = on; }
  /** Whether they do so, and there is more than one such process. */
  bool GetDrawsTogether();

  ///@{
  /**
   * Of path tracing: paths through each pixel of a converged picture; the noise falls with their
   * square root. More go on from what is there. Default 64.
   */
  vtkSetClampMacro(SamplesPerPixel, int, 1, VTK_INT_MAX);
  vtkGetMacro(SamplesPerPixel, int);
  ///@}

  ///@{
  /**
   * Of path tracing: what a collision with white leaves of the light; the rest is absorbed. 0 is
   * soot, 1 a cloud. Default 1.
   */
  vtkSetClampMacro(ScatteringAlbedo, double, 0.0, 1.0);
  vtkGetMacro(ScatteringAlbedo, double);
  ///@}

  ///@{
  /**
   * Of path tracing: mean cosine of the angle by which a collision turns light, after Henyey and
   * Greenstein; 0 scatters evenly, above 0 forward, below 0 back. Default 0.
   */
  vtkSetClampMacro(Anisotropy, double, -0.99, 0.99);
  vtkGetMacro(Anisotropy, double);
  ///@}

  ///@{
  /**
   * Of path tracing: collisions after which a path is given up. 1 is single scattering; dense white
   * media need many. Default 16.
   */
  vtkSetClampMacro(MaximumBounces, int, 0, VTK_INT_MAX);
  vtkGetMacro(MaximumBounces, int);
  ///@}

  ///@{
  /**
   * Of path tracing: red, green and blue light that comes from everywhere outside the volume, none
   * of them negative. It is never seen directly: the background is the renderer's. Default 0.5
   * each.
   */
  vtkSetVector3Macro(AmbientLight, double);
  vtkGetVector3Macro(AmbientLight, double);
  ///@}

  ///@{
  /**
   * Distance between samples in voxels, along the axis in which the voxels are densest. Smaller is
   * slower and closer to the integral. Interactive pictures have twice that. Path tracing has no
   * such samples. Default 0.5.
   */
  vtkSetClampMacro(SampleDistance, double, 0.01, 100.0);
  vtkGetMacro(SampleDistance, double);
  ///@}

  ///@{
  /**
   * Whether samples where little can be seen stand for up to four sample distances, in composited,
   * ray-marched pictures. Default on.
   */
  vtkSetMacro(AdaptiveSampling, bool);
  vtkGetMacro(AdaptiveSampling, bool);
  vtkBooleanMacro(AdaptiveSampling, bool);
  ///@}

  ///@{
  /**
   * Whether composited pictures take into account all values between a sample and the one before,
   * as if the field were linear there (pre-integrated classification), instead of the sample's own
   * value: thin peaks in the opacity show with far less grain at the same SampleDistance, for some
   * 1.5 times the time. With an ErrorTolerance of 0 or more it does not count. Default off.
   */
  vtkSetMacro(PreIntegration, bool);
  vtkGetMacro(PreIntegration, bool);
  vtkBooleanMacro(PreIntegration, bool);
  ///@}

  ///@{
  /**
   * How coarse the levels are that far voxels are read from: 1, the default, makes a voxel at most
   * a seventh larger than a pixel, and at least half as large where it is not of the full
   * resolution; 0 always reads the full resolution; 2 is faster and softer.
   */
  vtkSetClampMacro(LevelOfDetailScale, double, 0.0, 64.0);
  vtkGetMacro(LevelOfDetailScale, double);
  ///@}

  ///@{
  /**
   * By how many 255ths a channel of the picture may differ from the one with every sample from the
   * full resolution, for 99.9 % of its pixels. Levels, distances of samples and the precision of
   * the cache (BITS16 where what that rounds cannot show, else FLOAT32) follow from it;
   * LevelOfDetailScale, AdaptiveSampling, PreIntegration, InferencePrecision and CachePrecision do
   * not count. 0: not at all. Below 0, the default: they do, and levels follow from the distance to
   * the viewer. Lit, cropped (but to a box), projected and path-traced pictures, those with a
   * SampleDistance above 1, and those of models whose values may leave the ranges that are known of
   * them, as instantvnr and cINR write them and as a reader's ScaleFactor above 1 makes them, are
   * as with 0. It needs the cache: CacheMode NETWORK_ONLY does without. It has to know the field
   * where that can be seen, which the first picture waits for: up to ten times as long as decoding
   * that; where it is more than some 450 million voxels, it goes by the ranges of macro-cells
   * alone, and most are of the full resolution. Rays end
   * at 0.999 of opacity, so below 0.3 it cannot be kept in opaque media.
   */
  vtkSetClampMacro(ErrorTolerance, double, -1.0, 255.0);
  vtkGetMacro(ErrorTolerance, double);
  ///@}

  enum CacheModes {
    CACHE_AND_NETWORK = 0, ///< voxels from the cache, decoded when they are first wanted
    CACHE_ONLY = 1,        ///< what the cache has no room for comes from coarser levels: fast
    NETWORK_ONLY = 2       ///< every sample straight from the network: exact, and slow
  };
  ///@{
  /**
   * One of CacheModes; anything else is refused. Default CACHE_AND_NETWORK. The first two differ
   * only in pictures that want more bricks than CacheSize has room for. With the network, what does
   * not fit is decoded for each picture and dropped or, of path tracing, asked for point by point:
   * the picture does not depend on CacheSize, but may take long. From the cache only, a picture has
   * converged when the cache is full, coarser where the finer bricks did not fit; GetCacheHitRate()
   * says how much of it is.
   */
  void SetCacheMode(int mode);
  vtkGetMacro(CacheMode, int);
  ///@}

  ///@{
  /**
   * Memory for decoded bricks, their tables and those on their way in MiB. 0, the default, is a
   * quarter of the memory that the process may use, at most 16 GiB; memory is taken as bricks come
   * in. All mappers of a process together stay within the largest CacheSize among them (or what
   * eight bricks for each volume take, should that be more): what was not looked at for longest
   * makes room; on a GPU all models have equal parts. Mappers of one model that agree in this,
   * CachePrecision and BrickSize share their bricks. What does not hold eight bricks and their
   * tables (1 MiB by default) is refused with an error at the next frame. A change empties the
   * cache unless another mapper shares it.
   */
  vtkSetClampMacro(CacheSize, int, 0, VTK_INT_MAX);
  vtkGetMacro(CacheSize, int);
  ///@}

  enum InferencePrecisions { SINGLE = 0, BFLOAT16 = 1, AUTOMATIC = 2 };
  ///@{
  /**
   * What the CPU's network computes with, one of InferencePrecisions. BFLOAT16 rounds weights and
   * what goes into a layer to 8 bits: values are off by up to 0.01 of their range, and with tile
   * registers (AMX) decoding is up to 3.4 times as fast as with SINGLE. AUTOMATIC, the default,
   * rounds to 16 bits where there are such registers, the cache has 16 bits or less for a value,
   * and the model has layers of 64 neurons or more and is off by no more in the mean than what 16
   * bits of the value range round: up to twice as fast, less of trained models, whose ReLU makes
   * many products zero. Both count where no GPU decodes; else, and with an ErrorTolerance, all is
   * as with SINGLE, as AUTOMATIC is elsewhere. A process that uses such registers needs 8 KiB more
   * in its signal stacks (sigaltstack). A change empties the cache.
   */
  vtkSetClampMacro(InferencePrecision, int, SINGLE, AUTOMATIC);
  vtkGetMacro(InferencePrecision, int);
  ///@}

  enum CachePrecisions { FLOAT32 = 0, BITS16 = 1, BITS8 = 2 };
  ///@{
  /**
   * How a cached voxel is stored, one of CachePrecisions. The integers divide the range of the
   * macro-cells that a brick is in or, where these may not hold, of its values. Default BITS16, the
   * fastest; its error is below the network's. A change empties the cache.
   */
  vtkSetClampMacro(CachePrecision, int, FLOAT32, BITS8);
  vtkGetMacro(CachePrecision, int);
  ///@}

  ///@{
  /**
   * Voxels per side of a cached brick. Default 40. A change empties the cache. One brick of 256
   * voxels takes seconds, and 64 MiB besides the cache. Below 40 there are coarser levels besides,
   * which pictures from far away take.
   */
  vtkSetClampMacro(BrickSize, int, 4, 1024);
  vtkGetMacro(BrickSize, int);
  ///@}

  ///@{
  /**
   * Bricks decoded at most before it is looked at again which ones the picture wants: few follow a
   * moving camera sooner, many take less of the time for looking. Default 40.
   */
  vtkSetClampMacro(MaximumRequests, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumRequests, int);
  ///@}

  ///@{
  /**
   * Whether an interactive frame decodes the bricks first that add most to the picture. Default on;
   * off takes them in the order of the picture's tiles.
   */
  vtkSetMacro(PriorityRanking, bool);
  vtkGetMacro(PriorityRanking, bool);
  vtkBooleanMacro(PriorityRanking, bool);
  ///@}

  ///@{
  /**
   * Whether what is missing is decoded level by level, from coarse to fine, so that an interactive
   * picture sharpens everywhere; off decodes the wanted level at once. Default on.
   */
  vtkSetMacro(Preloading, bool);
  vtkGetMacro(Preloading, bool);
  vtkBooleanMacro(Preloading, bool);
  ///@}

  ///@{
  /**
   * Seconds after which a still frame is shown with what is there and refined in the following
   * ones, which the mapper asks the window's interactor for: short ones, with pauses for events in
   * between, and none while somebody interacts or RefineEvent is answered with no. A frame that
   * takes the place of one that is still refined is such a short one, too. Where a ray or
   * path through each pixel takes more than twice as long, and a quarter of a second, one with
   * fewer pixels is shown until there was time for all (not where a GPU draws, and rays not
   * with NETWORK_ONLY). Volumes of such mappers that a renderer shows share all these times. 0: a
   * still frame is complete, however long it takes. Below 0, the default: 0.5 where the window has
   * an interactor, else 0. ParaView's screenshots, tiles of
   * larger ones (SetTileScale) and offscreen windows are always complete; of others that render the
   * window anew, as vtkWindowToImageFilter does by default, set it to 0 before.
   */
  vtkSetMacro(StillTimeLimit, double);
  vtkGetMacro(StillTimeLimit, double);
  ///@}

  ///@{
  /**
   * Whether somebody else shows what is drawn into a window of nobody's, and has it drawn again
   * where TakeRefinementPause() says so: then StillTimeLimit holds for it, too. Default off. No
   * picture looks different for it, so it modifies nothing.
   */
  void SetShownElsewhere(bool on) { this->ShownElsewhere = on; }
  vtkGetMacro(ShownElsewhere, bool);
  vtkBooleanMacro(ShownElsewhere, bool);
  ///@}

  /**
   * Seconds until a still picture with ShownElsewhere, drawn since this was asked before, is to be
   * drawn again, which goes on with it; 0: there is no such picture, or nothing left to do.
   */
  double TakeRefinementPause();

  ///@{
  /**
   * Whether a picture is made for a selection to begin with, into a window that does not show it,
   * as a screenshot's: but nobody keeps it, and it takes no longer than what the window shows.
   * Default off. It modifies nothing either.
   */
  void SetForSelection(bool on) { this->ForSelection = on; }
  vtkGetMacro(ForSelection, bool);
  ///@}

  ///@{
  /**
   * Whether somebody drags something that the picture follows, as a point of a transfer function:
   * where that has changed a still picture that is refined, see StillTimeLimit, one with
   * fewer pixels is shown first, which takes no longer than an interactive one. Default off. It
   * modifies nothing either.
   */
  void SetHurried(bool on) { this->Hurried = on; }
  vtkGetMacro(Hurried, bool);
  vtkBooleanMacro(Hurried, bool);
  ///@}

  ///@{
  /**
   * For a mapper beside `window`, which shows what another one draws elsewhere: whether pictures
   * there may be refined, which those of a screenshot may not; and to have the window drawn again
   * in so many seconds, as for a picture of one's own, instead of what was asked for before. 0: not
   * at all.
   */
  static bool MayRefine(vtkRenderWindow* window);
  void RefineLater(vtkRenderWindow* window, double pause);
  ///@}

  /**
   * Invoked before the mapper has its window refine a picture; the call data are a bool* that an
   * observer in a busy application sets to false. It is then asked again a little later. Observers
   * may delete the mapper.
   */
  enum { RefineEvent = vtkCommand::UserEvent + 73 };

  ///@{
  /**
   * Whether frames count, for WriteEXR(), how many samples each pixel takes and from which levels
   * of resolution. Default off.
   */
  vtkSetMacro(SampleChannels, bool);
  vtkGetMacro(SampleChannels, bool);
  vtkBooleanMacro(SampleChannels, bool);
  ///@}

  ///@{
  /** Threads that compute a frame; 0, the default, means every core this process may use. */
  vtkSetClampMacro(NumberOfThreads, int, 0, 4096);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Seed of the samples' random offsets along their rays, and of paths. Where samples have none
   * (maxima, minima, isosurfaces and PreIntegration), it chooses between two levels of resolution
   * where one passes into the next. Default 0.
   */
  vtkSetClampMacro(Seed, int, 0, VTK_INT_MAX);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Whether pictures that somebody waits for depend on how fast the machine is. On: each of them
   * does a fixed amount of work, however long it takes: one pass of rays or one path through each
   * pixel, then MaximumRequests bricks; nothing goes on between them; and interactive pictures have
   * a quarter of the window's resolution. So a sequence of renderings is the same pictures whenever
   * it is repeated from the start, with any NumberOfThreads, if all INR volumes of the process have
   * it on. Default off: pictures keep to their time. A change empties the cache.
   */
  vtkSetMacro(Deterministic, bool);
  vtkGetMacro(Deterministic, bool);
  vtkBooleanMacro(Deterministic, bool);
  ///@}

  ///@{
  /**
   * About the last frame drawn, of several views the one that came last; 0 before the first:
   * seconds from the call to the drawn picture, samples looked up or inferred, samples that lay
   * outside their macro-cell's range and were moved into it, and how many times smaller than the
   * viewport the picture's width and height were.
   */
  double GetFrameTime() const;
  vtkIdType GetNumberOfSamples() const;
  vtkIdType GetNumberOfClampedSamples() const;
  int GetImageReduction() const;
  ///@}

  ///@{
  /**
   * What the last call had to do: points at which the network was asked but for bricks, bricks that
   * it decoded (those that come in behind the application belong to the next call), and macro-cells
   * that rays looked at. All 0 where nothing had changed since a picture that is complete: it is
   * shown again.
   */
  vtkIdType GetNumberOfNetworkSamples() const;
  vtkIdType GetNumberOfDecodedBricks() const;
  vtkIdType GetNumberOfVisitedCells() const;
  ///@}

  ///@{
  /**
   * About the last frame and the cache: whether it was shown and every sample came from the level
   * it asked for or, of CACHE_ONLY, the best that a full cache has, and, of path tracing,
   * SamplesPerPixel were taken (false before the first frame and when one is refused or aborted);
   * the part of the samples that did (0 to 1; 1 where the view misses the volume, for nothing is
   * missing, and 0 when nothing was drawn); and the memory in MiB that the caches of all mappers of
   * the process have in use now (0 while this one has none).
   */
  bool GetConverged() const;
  double GetCacheHitRate() const;
  double GetCacheUsed() const;
  ///@}

  ///@{
  /**
   * Levels of resolution that the last frame's samples came from, the finest and the coarsest: 0 is
   * the full resolution, each further one halves the voxels per axis. -1 when no sample came from
   * the cache.
   */
  int GetFinestLevel() const;
  int GetCoarsestLevel() const;
  ///@}

  /** Paths through each pixel in the last frame; 0 when rays were marched. */
  vtkIdType GetNumberOfPaths() const;

  /**
   * What computed the last frame: "CPU avx512, 2 threads", or, of what a GPU inferred, "CPU avx512,
   * 2 threads; bricks by CUDA float32, NVIDIA H200", or, if that has drawn it itself, "CUDA
   * float32, NVIDIA H200; beside it CPU avx512, 2 threads". Empty before the first.
   */
  const char* GetBackendInUse() const;

  /** Width and height of the last frame's picture in pixels; 0 before the first. */
  void GetFrameSize(int size[2]) const;

  /**
   * When the last frame was drawn; 0 before the first. Of several mappers, the one with the largest
   * was the last to draw.
   */
  vtkMTimeType GetFrameMTime() const;

  /** Why nothing was drawn when that was last asked for, as the error said that came; or empty. */
  const char* GetWhyNotDrawn() const;

  /** Whether the last frame read the depth of opaque geometry. */
  bool GetOpaqueDepthRead() const;

  /**
   * Writes the last frame as OpenEXR, exact: premultiplied float R, G, B, A and window-space depth
   * Z of the volume alone, where its opacity first reaches one half. With translucent surfaces in
   * the view it is what lies over a picture of these. With SampleChannels also "samples", how many
   * the pixel took, and "level", the mean of the levels that they came from (-1 where it took
   * none), or a warning where these are not known: of paths, and without a cache. False, with an
   * error, when there is no frame or the file cannot be written.
   */
  bool WriteEXR(const char* fileName);

  /**
   * Bounds of what is drawn: those of the input (of the whole grid, if processes draw it together),
   * and one spacing along an axis of one voxel.
   */
  double* GetBounds() VTK_SIZEHINT(6) override;
  using vtkVolumeMapper::GetBounds;

  /** Point bounds of the whole grid that the input has a piece of; left as they are without one. */
  void GetWholeBounds(double bounds[6]);
  /**
   * Point bounds of the piece that the input has of it, without its ghost cells; left as they are
   * without one.
   */
  void GetPieceBounds(double bounds[6]);
  /** Where in the whole grid that piece begins and ends along each axis, 0 to 1. */
  void GetPartOfWhole(double part[6]);
  /** Whether the input is a piece of a grid that other processes have the rest of. */
  bool GetHasPiece();

  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkINRVolumeMapper();
  ~vtkINRVolumeMapper() override;

  /** What CUDA stands for: null, with the reason, where there is nothing that can be used. */
  virtual std::shared_ptr<const inr::Accelerator> FindAccelerator(std::string& reason);

private:
  vtkINRVolumeMapper(const vtkINRVolumeMapper&) = delete;
  void operator=(const vtkINRVolumeMapper&) = delete;

  void ReportOnce(const std::string& problem);
  std::shared_ptr<const inr::Accelerator> WantedAccelerator();
  std::string WhyNotAccelerated() const;
  void ReportBackend();
  void RenderForSelection(vtkRenderer* renderer, vtkVolume* volume);
  void DrawVolumesBehind(vtkRenderer* renderer, vtkVolume* volume);

  inr::PaintSettings Settings() const;
  inr::PaintSettings PresentSettings(vtkRenderer* renderer, vtkVolume* volume);

  int RenderMode = RAY_MARCHING;
  int Backend = AUTO;
  int LocalRank = 0;
  std::vector<int> ProcessOrder;
  bool AlwaysTogether = false;
  int SamplesPerPixel = 64;
  double ScatteringAlbedo = 1.0;
  double Anisotropy = 0.0;
  int MaximumBounces = 16;
  double AmbientLight[3] = {0.5, 0.5, 0.5};
  double SampleDistance = 0.5;
  bool AdaptiveSampling = true;
  bool PreIntegration = false;
  double LevelOfDetailScale = 1.0;
  double ErrorTolerance = -1.0;
  int CacheMode = CACHE_AND_NETWORK;
  int CacheSize = 0;
  int InferencePrecision = AUTOMATIC;
  int CachePrecision = BITS16;
  int BrickSize = 40;
  int MaximumRequests = 40;
  bool PriorityRanking = true;
  bool Preloading = true;
  double StillTimeLimit = -1.0;
  bool ShownElsewhere = false;
  bool ForSelection = false;
  bool Hurried = false;
  int NumberOfThreads = 0;
  int Seed = 0;
  bool Deterministic = false;
  bool SampleChannels = false;

  struct Internals;
  std::unique_ptr<Internals> Self;
};

#endif
