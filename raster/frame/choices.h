// Names for the numbers that some fields of FrameDesc hold: desc.brdf = choice::brdf::beckmann. Each struct has its field's name.
#pragma once

namespace burnish::choice {

struct brdf {
    enum : int {
#define BN_LOBE(id, at, type, lies, normals, traits, made_of) id = at,
#include "shading/models.def"
    };
};

struct area_way {
    enum : int {
#define BN_AREA_LIGHTS(id, at, name, summary) id = at,
#include "shading/models.def"
    };
};

struct diffuse_model {
    enum : int { lambert, ashikhmin_shirley };
};

struct masking {
    enum : int { correlated, separable };
};

struct dfg_fit {
    enum : int { table, fit };
};

struct fresnel {
    enum : int { schlick, conductor, dielectric };
};

struct frame_map {
    enum : int { gram_schmidt, quaternion, normal_only, off };
};

struct pom_metric {
    enum : int { uv, surface };
};

struct horizon {
    enum : int { off, on };
};

struct as_tables {
    enum : int { on, off };
};

struct glass {
    enum : int { interface, body };
};

} // namespace burnish::choice
