// Compares an engine's pictures with references, and finds the mistakes that explain them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/lab/conform/draw.h"
#include "core/base/result.h"
#include "core/image/image.h"

namespace burnish {

struct EnginePicture {
    std::string file;  // as read; empty: there is none
    std::string fault; // why it cannot be compared; empty: it can
    bool not_finite = false;
    Image shown; // as displays show it: u8 RGB at kConformEv
    bool from_eight_bits = false;
};

inline constexpr int kExposure = -1, kNoMistake = -2; // beside the indices into mutants()
std::string mistake_name(int mutant);
std::string mistake_words(int mutant, double exposure_ev);

struct SceneJudgement {
    enum class Outcome { right, wrong, unusable, missing };
    std::string name;
    Outcome outcome = Outcome::missing;
    std::string reason;      // for unusable and missing ones
    bool not_finite = false; // the picture holds NaN or infinities
    bool from_eight_bits = false;
    double to_reference = 0.0;     // the picture's mean LDR-FLIP to the reference
    double way_to_reference = 0.0; // from Judgement::way to the reference
    double to_right = 0.0;         // from the picture to the reference or to Judgement::way, the least
    double to_way = 0.0;           // from the picture to Judgement::way
    int nearest = kNoMistake;      // none is nearer than Judgement::way
    double to_nearest = 2.0;       // from the picture to that one
    double nearest_ev = 0.0;       // its exposure, if it is kExposure
    double explained = 0.0;        // from the picture to the one with the mistakes found; to_way without any
};

struct FoundMistake {
    int mutant = kNoMistake;
    std::vector<std::string> scenes;  // that it changes
    double before = 0.0, after = 0.0; // their pictures' mean FLIP to pictures without and with the mistake
};

struct Judgement {
    const RightWay* way = &right_ways().front(); // without a mistake, nearest to the pictures
    std::vector<SceneJudgement> scenes;
    double noise = 0.0;                 // mean FLIP from the engine's right pictures to its way: the engine filters light in its own way
    double right_up_to = 0.0;           // mean FLIP to the reference or to the engine's way
    std::vector<FoundMistake> mistakes; // the one that explains most comes first
    double exposure_ev = 0.0;           // the pictures' exposure against the right one, where a mistake; else 0
    bool all_right() const;
    bool way_is_known() const;                    // most scenes are right, or explained
    std::vector<std::string> unexplained() const; // scenes that are wrong, and look like no known mistake
};

// Judges the pictures, one for each scene in the folder.
Result<Judgement> judge_pictures(ConformDrawer& drawer, const ConformFolder& folder, const std::vector<Image>& references,
                                 const std::vector<EnginePicture>& pictures, const Jobs& jobs);

// Returns the picture as displays show it at kConformEv, u8 RGB.
Image shown_picture(const Image& linear);

// Returns two pictures' mean LDR-FLIP.
double mean_flip(const Image& reference, const Image& test, const Jobs& jobs);

} // namespace burnish
