// Errors of a probe's pictures, by material: HDR-FLIP between them, and what two noisy pictures tell about a third.
#pragma once
#include <vector>

#include "core/image/metrics/flip.h"
#include "core/jobs/jobs.h"
#include "core/scene/draw_tables.h"
#include "raster/frame/frame.h"

namespace burnish {

inline constexpr int kUnseen = -1;

// The probe pixels' materials; kUnseen for pixels without a solid surface, or with blended surfaces before it.
struct PixelMaterials {
    std::vector<int> of; // [pixel]
    int width = 0, height = 0;
    std::vector<double> pixels; // of each material
};

PixelMaterials materials_of(const Frame& frame, const DrawTables& tables, std::size_t count); // count: the scene's materials

// Squared distance between colours that a FLIP error stands for, and back. Independent errors' squares add.
double squared(double flip);
double flip_of(double square);
// Returns the error of both, which are independent.
double sum_of_errors(double a, double b);

// Returns the mean error over each material's pixels.
std::vector<double> mean_errors(const Image& error, const PixelMaterials& materials);

// Error moments over a material's pixels: for a picture against noisy ones, and for one noisy picture.
struct Moments {
    double mean = 0.0, square = 0.0, noise_square = 0.0; // mean error, squared errors' means
    double deviation = 0.0;                              // standard error of `square` - `noise_square`
};

// of_a, of_b: the picture's errors against two independent noisy ones; of_noise: errors between these two. Pixel blocks tell the
// deviation.
std::vector<Moments> moments_of(const Image& of_a, const Image& of_b, const Image& of_noise, const PixelMaterials& materials);

// Returns the picture's mean error without the pictures' noise. The measured error counts as far as it exceeds its deviation; `guess`
// counts for the rest.
double error_without_noise(const Moments& m, double guess);

// Returns two noisy pictures' error as FLIP filters a frame, relative to `error`, as it filters the probe.
double noise_filter(const Image& a, const Image& b, const Image& error, FlipOptions flip, const Jobs& jobs);

} // namespace burnish
