// Trains a cascade: procedural materials, tonemapped differences as the loss, Adam (Kingma, Ba 2015) with a cosine schedule, and a moving
// average of the numbers as the result.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/jobs/jobs.h"
#include "core/simd/dispatch.h"
#include "shading/bake/mipnet/weights.h"
#include "shading/lab/mipnet/step_fns.h"
#include "shading/lab/mipnet/training_batch.h"

namespace burnish::mipnet {

struct TrainOptions {
    Shape shape;
    std::uint64_t seed = 1;
    int steps = 3000;
    int shards = 2;                      // per step, with 16 tiles each; threads share them
    int pairs = 32;                      // direction pairs per tile and step
    int seeds = 24, side = kTrainedSide; // of the training set: materials per family, texels
    double rate = 2e-3;
    Loss loss = Loss::l1;
    Tone tone = Tone::display;
    double mirrored = kDefaultMirrored;            // share of direction pairs near highlights
    double light = 0.0;                            // weight of |mean radiance of a tile's level over the target's - 1|, beside the loss
    int levels = kTrainedLevels;                   // the loss looks at the first ones: 2 see H_B once, 5 four times
    std::vector<Material> maps;                    // trained on, too; squares
    bool only_maps = false;                        // and on nothing else
    std::shared_ptr<const Weights> from;           // what training begins at, of the same shape; null: anything
    std::shared_ptr<const Weights> distilled_from; // whose levels' light is wanted in place of level 0's, of the same lobe
    std::string command;                           // that makes the same weights: kept in their file
    std::string checkpoint;                        // a file to go on from and to keep up to date; empty: none
    double checkpoint_seconds = 15;                // between two of them
    const std::atomic<bool>* stop = nullptr;       // set by another thread or a signal: end soon, with everything in the checkpoint
    std::function<void(int step, double loss)> advance{}; // after each step; mean over shards and levels
    Isa isa = best_isa();
};

// Trains. The bytes depend neither on threads, nor on the instruction set, nor on interruptions. Returns nothing if stopped. A checkpoint
// with other options, or a damaged one, is an Error.
Result<std::optional<Weights>> train(const TrainOptions& options, const Jobs& jobs);

} // namespace burnish::mipnet
