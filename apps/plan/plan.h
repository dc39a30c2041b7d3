// Plans a frame: chooses each material's technique and samples, so that the picture's error holds a budget at the least cost.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/plan/probe.h"
#include "core/base/result.h"

namespace burnish {

struct PlanBudget {               // at least one
    std::optional<double> error;  // the picture's largest mean HDR-FLIP, above 0
    std::optional<double> p99;    // the largest 99th percentile of its pixels' HDR-FLIP, above 0
    std::optional<double> cpu_ms; // the frame's largest processor time on this machine; errors go first
};

struct PlanStep { // one material's setting
    MaterialTechnique setting;
    double error = 0.0, cost = 0.0; // mean HDR-FLIP over its pixels; instructions for all its pixels
};

struct AreaLightsStep { // one method for all area lights
    AreaLightsSetting setting;
    double error = 0.0, cost = 0.0; // part of the picture's mean HDR-FLIP if all other light were exact; instructions for all its pixels
};

struct PlannedAreaLights {
    AreaLightsStep chosen;
    std::optional<AreaLightsStep> cheaper, better; // the next methods that none beats in cost and error
};

struct PlannedMaterial {
    std::string name;   // the scene's, or "material 3"
    double share = 0.0; // of the picture's pixels
    PlanStep chosen;
    std::optional<PlanStep> cheaper, better; // the next settings that none beats in cost and error
    std::vector<PlanStep> all;               // every setting that was probed
};

// A frame's choices by a plan.
struct PlannedFrame {
    std::vector<MaterialTechnique> by_material;   // by index in the scene; empty: no plan
    std::optional<AreaLightsSetting> area_lights; // empty: the frame's own
    void put(FrameDesc& desc) const;
};

struct Plan {
    std::vector<PlannedMaterial> materials;       // by index in the scene
    std::optional<PlannedAreaLights> area_lights; // empty where no area light gives light
    double error = 0.0;                           // the picture's predicted mean HDR-FLIP
    std::optional<double> p99;                    // predicted; only for a budget of it
    double cost = 0.0, default_cost = 0.0;        // instructions for shading, and the default technique's instructions
    std::optional<double> default_error;          // predicted for the default technique; none: the probe has it not
    int probe_width = 0, probe_height = 0;
    std::optional<double> cpu_ms; // predicted; only for a time budget
    std::string aside;            // why nothing was planned: then `materials` is empty
    PlannedFrame frame() const;
};

// Factor on predictions before they are held to a budget; the notebook has errors over predictions.
inline constexpr double kPlanSafety = 1.3;
inline constexpr double kTailSafety = 1.3;  // the same for the 99th percentile
inline constexpr double kTimeSafety = 1.05; // the same for times

struct PlanFixed {              // by the user
    std::string technique = {}; // empty: none
    int samples = 0;            // 0: none
    bool area_lights = false;   // the frame's method for area lights
};

// A time budget draws the cheapest plan once, to measure. Errors: ExitCode::usage for a budget that no setting reaches; Error::field names
// the option if it is not the first of those given.
Result<Plan> make_plan(Session& session, const FrameDesc& desc, const PlanBudget& budget, const PlanFixed& fixed = {});

// Returns a plan in words: a line for the picture, then one for each visible material.
std::vector<std::string> plan_lines(const Plan& plan, const PlanBudget& budget);

// A plan's subject. A plan for another subject is refused.
struct PlanSubject {
    std::string scene, environment, view; // names, and the camera in words
    int width = 0, height = 0;
    std::string content; // hash over scene, environment and options
};
std::string plan_json(const Plan& plan, const PlanSubject& subject);
// Reads a plan file's settings. Errors: ExitCode::bad_input, with the JSON path of the first member that differs from `subject` or is
// malformed.
Result<PlannedFrame> read_plan(const std::string& path, const PlanSubject& subject, std::size_t materials);

} // namespace burnish
