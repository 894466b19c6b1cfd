// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/CachedRenderer.h"

#include "Core/Error.h"
#include "Core/Render/Acceleration/AcceleratedField.h"
#include "Core/Render/Tiles/TileLoop.h"
#include "Core/Render/Tiles/WorkLimit.h"

#include <algorithm>
#include <memory>
#include <new>

namespace inr {

namespace {

const CacheOptions& Checked(const CacheOptions& options)
{
  if (options.bytes < 0 || options.maximumRequests < 1) {
    throw Error(ErrorCode::InvalidArgument,
                "a cache needs a size that is not negative and at least one request at a time");
  }
  return options;
}

/// What all renderers of the same field with the same options share.
std::shared_ptr<BrickStore> StoreFor(const CachedField& of, const CacheOptions& options,
                                     const Arena& arena)
{
  const std::int64_t bytes = options.bytes > 0 ? options.bytes : DefaultCacheBytes();
  const std::shared_ptr<CacheBudget> budget = CacheBudget::ofProcess();
  const StoreKey key{of.identity, of.cells,           of.field->kernel(),
                     of.dims,     options.brickSize,  options.precision,
                     bytes,       options.background, of.accelerator};
  return budget->storeFor(key, [&] {
    std::shared_ptr<const BrickSource> source = MakeBrickSource(
        of.field, Hierarchy(of.dims, options.brickSize, of.field->resolution()), of.cells);
    if (of.accelerator) {
      source = MakeBrickSource(of.accelerator, of.model, std::move(source));
    }
    return std::make_shared<BrickStore>(budget, std::move(source), options.precision, bytes,
                                        options.background, arena.threads());
  });
}

/// What of bricks is to be loaded for a scene: where samples are chosen for a tolerance, whole
/// ones, as it will look at more of them later.
std::vector<BrickPart> PartsFor(const CachedScene& scene, const std::vector<BrickKey>& keys)
{
  return scene.frame.errorTolerance.value_or(0) > 0
             ? std::vector<BrickPart>(keys.begin(), keys.end())
             : scene.bricks->wanted(keys);
}

} // namespace

CachedRenderer::CachedRenderer(const CachedField& field, const CacheOptions& options,
                               const BrickKernel& kernel, const Arena& arena)
    : Options(Checked(options)), Kernel(kernel), Threads(arena), Field(field.field),
      Store(StoreFor(field, options, arena))
{}

CachedRenderer::~CachedRenderer()
{
  this->Store->forgetRequests(); // who else draws the field asks again
}

void CachedRenderer::beginFrame() { this->Latest = this->Store->beginFrame(); }

const std::shared_ptr<const StepTable>& CachedRenderer::stepsFor(const ColorLookup& colors,
                                                                 double stepLength)
{
  const int lengths = SampleLengths(this->Store->cache().hierarchy().levels());
  if (!this->Steps || !this->Steps->fits(stepLength, lengths)) {
    this->Steps = std::make_shared<const StepTable>(colors, stepLength, lengths);
  }
  return this->Steps;
}

std::shared_ptr<const BlockVisibility>
CachedRenderer::blocksFor(const ColorTable& colors, const MarchSettings& settings, bool rangesHold)
{
  if (!rangesHold) { // what is moved into them may show what its block does not
    return nullptr;
  }
  if (settings.projector.projects() || settings.projector.findsSurfaces() || !colors.hidesAny()) {
    return nullptr; // all values matter
  }
  if (!this->Blocks) {
    this->Blocks = std::make_shared<const BlockVisibility>(this->Store->cache(), colors);
  }
  return this->Blocks;
}

const std::shared_ptr<const SufficientBricks>& CachedRenderer::bricksFor(const Majorants& majorants,
                                                                         std::optional<int> reach)
{
  const bool fits = this->Bricks && this->Bricks->wantsAll() == !reach &&
                    this->Bricks->reach() == reach.value_or(0);
  if (!fits) {
    const BrickCache& cache = this->Store->cache();
    std::optional<VisibleBlocks> wanted;
    if (reach) {
      wanted.emplace(cache.hierarchy(), majorants.view(), *reach);
    }
    this->Bricks = std::make_shared<const SufficientBricks>(cache, wanted);
  }
  return this->Bricks;
}

RequestRanking CachedRenderer::inSteps(const RequestRanking& requests, std::int64_t room) const
{
  if (!this->Options.preloading || requests.count() <= room) {
    return requests;
  }
  const Hierarchy& hierarchy = this->Store->cache().hierarchy();
  return requests.replaced([&](BrickKey key) {
    const BrickId id = IdOf(key);
    const bool mayStep =
        id.level + 1 < hierarchy.levels() && !hierarchy.view().isOnTheWay(id.level + 1);
    const BrickKey coarser = mayStep ? KeyOf(hierarchy.coarser(id)) : key;
    return this->Bricks->find(coarser) == PageTable::Unmapped ? coarser : key;
  });
}

void CachedRenderer::forgetColors()
{
  this->Unfinished.reset();
  this->Steps.reset();
  this->Blocks.reset();
  this->Bricks.reset();
}

FrameStatistics CachedRenderer::render(const MarchJob& job, const Majorants& majorants,
                                       const ColorTable& colors, const DrawCall& call)
{
  const Frame& frame = job.frame;
  const MarchSettings& settings = job.settings;
  this->Work = {};
  std::optional<Refinement>& refined = this->Unfinished.of(frame.view).refined;
  const bool isLimited = call.limit.isLimited();
  if (refined && isLimited && refined->continues(frame, call.output)) {
    try {
      return this->refine(*refined, call);
    } catch (const std::bad_alloc&) { // in the midst of its rays: nobody knows how far they are
      refined.reset();
      throw;
    }
  }
  if (isLimited) { // else it is captured, and what is on the screen goes on afterwards
    refined.reset();
  }
  const auto steps = this->stepsFor(job.colors, settings.step * settings.unitsPerT);
  const BrickCache& cache = this->Store->cache();
  const auto blocks = this->blocksFor(colors, settings, majorants.rangesHold());
  // With samples chosen for a tolerance; until these are, less is enough.
  const bool looksFurther = settings.looksAtBothEnds() || settings.cellSampling != nullptr;
  std::optional<int> reach;
  if (blocks != nullptr && !looksFurther) {
    reach = job.shading != nullptr ? 1 : 0; // gradients
  }
  const auto seen =
      std::make_shared<const SeenSpans>(job.geometry.view(), majorants.view(), settings.dims,
                                        frame.levelOfDetailScale, cache.hierarchy().levels());
  const CachedScene scene{frame,        job.geometry,    majorants,
                          job.colors,   steps,           this->bricksFor(majorants, reach),
                          this->Kernel, FormatOf(cache), settings,
                          job.shading,  blocks,          seen};
  FrameStatistics statistics = this->renderFrame(scene, call);
  statistics.work = this->Work;
  return statistics;
}

FrameStatistics CachedRenderer::renderFrame(const CachedScene& scene, const DrawCall& call)
{
  if (this->Options.onlyWhatFits) {
    return this->renderWhatFits(scene, call);
  }
  return call.limit.isLimited() ? this->renderInTime(scene, call)
                                : this->renderComplete(scene, call);
}

FrameStatistics CachedRenderer::renderComplete(const CachedScene& scene, const DrawCall& call)
{
  CompletePass pass(scene);
  double marching = 0;
  while (true) {
    const Timer march;
    this->beginFrame();
    RequestRanking requests;
    this->Work.add(pass.advance(this->Threads, call.keepGoing, call.output, requests));
    marching += march.seconds();
    if (pass.done()) {
      break;
    }
    this->loadForPass(pass, requests, this->Store->cache().capacity() - 1, call.keepGoing);
    RequireGoing(call.keepGoing);
  }
  FrameStatistics statistics = pass.statistics();
  statistics.complete = true;
  statistics.marchSeconds = marching;
  return statistics;
}

void CachedRenderer::loadForPass(CompletePass& pass, const RequestRanking& requests,
                                 std::int64_t most, const std::function<bool()>& keepGoing)
{
  // Room for what waits now must not be taken from what was loaded a moment ago for the same rays.
  const std::int64_t room = this->Store->cache().capacity() - 1;
  std::vector<BrickKey> keys = requests.ranked(std::min(most, room), false);
  if (pass.isAlone()) {
    keys = {keys.back()};
  }
  const BrickStore::Loaded loaded =
      this->Store->load(PartsFor(pass.scene(), keys), this->Threads, keepGoing);
  if (loaded.full && pass.isAlone()) {
    // A batch of one ray's samples has used all that there is and waits for more: its first sample
    // can have what it needs when the others have nothing.
    this->Store->clear();
  }
  if (loaded.full) {
    pass.crowd(loaded.bricks);
  }
}

bool CachedRenderer::loadForFrame(std::vector<BrickPart> parts, const WorkLimit& limit,
                                  const std::function<bool()>& keepGoing, double part)
{
  if (limit.isTimed()) {
    this->Store->loadFor(limit.secondsForLoading(part), std::move(parts), this->Threads);
    return false;
  }
  return this->Store->load(std::move(parts), this->Threads, keepGoing).full;
}

FrameStatistics CachedRenderer::march(const CachedScene& scene, MarchedTiles& tiles,
                                      const DrawCall& call, RequestRanking& requests)
{
  const OnMiss onMiss = this->Options.preloading ? OnMiss::Approach : OnMiss::UseCoarser;
  // Tiles that stay as they are show what they did.
  tiles.latestFrame = this->Latest = this->Store->beginFrame(tiles.latestFrame);
  const FrameStatistics statistics = tiles.march(scene, onMiss, this->Threads, call, requests);
  this->Work.add(statistics.work);
  return statistics;
}

MarchedTiles CachedRenderer::tilesFor(const CachedScene& scene, const DrawCall& call)
{
  const Frame& frame = scene.frame;
  const std::unique_ptr<KeptPicture> kept = std::move(this->Unfinished.of(frame.view).kept);
  const bool goesOn = kept && kept->has(call.output) && kept->isOf(frame);
  const bool isOver = kept && kept->has(call.output) && !goesOn && kept->isBefore(frame);
  if (goesOn || isOver) {
    kept->copyTo(call.output);
  }
  return goesOn ? kept->take() : MarchedTiles(frame.width, frame.height, isOver);
}

void CachedRenderer::keep(const CachedScene& scene, MarchedTiles tiles, const DrawCall& call)
{
  this->Unfinished.of(scene.frame.view).kept =
      std::make_unique<KeptPicture>(scene.frame, std::move(tiles), call.output);
}

FrameStatistics CachedRenderer::renderInTime(const CachedScene& scene, const DrawCall& call)
{
  MarchedTiles tiles = this->tilesFor(scene, call);
  // Whoever takes from this picture what it has will do so again.
  const bool contested = this->Store->hasLostSince(tiles.latestFrame.value_or(this->Latest));
  while (true) {
    RequestRanking requests;
    const FrameStatistics statistics = this->march(scene, tiles, call, requests);
    const std::int64_t room = this->room();
    const bool fits = !contested && requests.count() <= room;
    const std::int64_t most = std::min<std::int64_t>(room, this->Options.maximumRequests);
    const RequestRanking wanted = this->inSteps(requests, room);
    this->loadForFrame(PartsFor(scene, wanted.ranked(most, this->Options.ranking)), call.limit,
                       call.keepGoing);
    if (statistics.complete) {
      return statistics;
    }
    if (!fits && !statistics.blank) { // should the same be asked for again
      this->Unfinished.of(scene.frame.view).refined.emplace(scene, call.output);
      return statistics;
    }
    if (call.limit.endsWithin(0) || call.limit.endsWithin(tiles.secondsToMarch(*scene.bricks))) {
      this->keep(scene, std::move(tiles), call);
      return statistics;
    }
  }
}

FrameStatistics CachedRenderer::renderWhatFits(const CachedScene& scene, const DrawCall& call)
{
  MarchedTiles tiles = this->tilesFor(scene, call);
  // Whoever takes from this picture what it has will do so again.
  bool full =
      call.limit.isLimited() && this->Store->hasLostSince(tiles.latestFrame.value_or(this->Latest));
  while (true) {
    RequestRanking requests;
    FrameStatistics statistics = this->march(scene, tiles, call, requests);
    const bool isWhole = tiles.areUpToDate(*scene.bricks); // else there was no time for it
    const std::int64_t room = this->room();
    // Not down to the last brick: fewer and fewer come in for all that they replace.
    const bool lacksRoom = full || room <= this->Store->capacity() / 64;
    const bool isLast = lacksRoom && !tiles.haveAsked; // with what there is
    statistics.complete = isWhole && (isLast || requests.empty());
    if (statistics.complete) {
      return statistics;
    }
    if (isWhole && lacksRoom) {
      tiles = MarchedTiles(scene.frame.width, scene.frame.height, true);
    } else if (isWhole) {
      // Nothing goes that is shown, so every place of the picture only gets finer.
      const std::int64_t most = call.limit.isLimited()
                                    ? std::min<std::int64_t>(room, this->Options.maximumRequests)
                                    : room;
      const RequestRanking wanted = this->inSteps(requests, room);
      full = this->loadForFrame(PartsFor(scene, wanted.ranked(most, this->Options.ranking)),
                                call.limit, call.keepGoing);
      tiles.haveAsked = true;
    }
    if (!isWhole || call.limit.endsWithin(tiles.secondsToMarch(*scene.bricks))) {
      this->keep(scene, std::move(tiles), call);
      return statistics;
    }
  }
}

FrameStatistics CachedRenderer::refine(Refinement& unfinished, const DrawCall& call)
{
  const WorkLimit& limit = call.limit;
  const std::int64_t most = limit.isTimed() ? this->Store->cache().capacity() - 1
                                            : std::int64_t{this->Options.maximumRequests};
  double marching = 0;
  // What is loaded here may be gone at the next call, so each one brings some ray further.
  const std::int64_t before = CamePast(unfinished.statistics());
  const auto inTime = [&] { return !limit.endsWithin(0); };
  const std::function<bool()>& mayLoad =
      limit.isTimed() ? std::function<bool()>(inTime) : call.keepGoing;
  while (true) {
    const Timer march;
    this->beginFrame();
    RequestRanking requests;
    this->Work.add(unfinished.advance(this->Threads, call.keepGoing, requests));
    marching += march.seconds();
    if (unfinished.done() || (!inTime() && CamePast(unfinished.statistics()) > before)) {
      break;
    }
    this->loadForPass(unfinished.pass(), requests, most, mayLoad);
  }
  unfinished.copyTo(call.output);
  FrameStatistics statistics = unfinished.statistics();
  statistics.complete = unfinished.done();
  statistics.marchSeconds = marching;
  statistics.work = this->Work;
  return statistics;
}

std::int64_t CachedRenderer::room() const
{
  // Below 0 where others have begun to share the memory meanwhile.
  return std::max<std::int64_t>(this->Store->capacity() - this->Store->cache().usedInFrame(), 0);
}

} // namespace inr
