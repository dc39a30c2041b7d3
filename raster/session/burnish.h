/* The C interface of libburnish: scenes, pictures, comparisons.
 *
 *   burnish_session* session;
 *   burnish_frame* frame;
 *   if (burnish_open("lamp.glb", NULL, NULL, &session) == 0 && burnish_render(session, NULL, &frame) == 0)
 *       burnish_write(frame, "lamp.png", 0.0f);
 *
 * Functions that return int return 0 for success, else an exit code of the program burnish: 1 differ, 2 wrong option, 3 sizes do not match,
 * 4 bad input, 6 not finite, 7 output failed, 70 a fault of burnish, 77 unavailable, 130 stopped. burnish_error() then says why. No
 * function ends the process or throws. Out-parameters are set on success alone, and freed by the caller.
 *
 * One thread at a time may use a session. Different sessions may be used by different threads at once. Freeing NULL does nothing. */
#pragma once
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BURNISH_API_VERSION 4 /* grows when functions or members are added; what is there keeps its meaning */

typedef struct burnish_session burnish_session; /* a scene under an environment, prepared for drawing */
typedef struct burnish_frame burnish_frame;     /* a picture and its layers */
typedef struct burnish_options burnish_options; /* names and values */

int burnish_api_version(void);
const char* burnish_version(void); /* "0.1.0" */
const char* burnish_error(void);   /* the last failure in this thread, one line; "" before the first */

/* Lists: an index from 0; NULL past the end. The texts live as long as the library. */
const char* burnish_option_name(int index); /* options of burnish_open, burnish_render and burnish_reference */
const char* burnish_option_help(int index);
const char* burnish_option_values(int index);  /* "int, 1 to 16384" */
const char* burnish_option_default(int index); /* as a value; "" where the option is unset */
/* The functions that read an option: bits. 0 past the end. */
enum { BURNISH_OPEN = 1, BURNISH_OPEN_MESHES = 2, BURNISH_SET_ENVIRONMENT = 4, BURNISH_RENDER = 8, BURNISH_REFERENCE = 16 };
unsigned burnish_option_calls(int index);
const char* burnish_material_name(int index); /* options of materials */
const char* burnish_light_name(int index);    /* options of lights */
const char* burnish_technique_name(int index);
const char* burnish_technique_help(int index);

/* Options. NULL in place of options means that none is set. Values are texts: "0.5", "1280", "1,0,0", "lobe_line", "true". A name that is
 * unknown is refused here, and so is a value out of range. burnish_open, burnish_open_meshes, burnish_set_environment, burnish_render and
 * burnish_reference may share options: each reads its own (burnish_option_calls). They refuse names of materials and lights. */
int burnish_options_make(burnish_options** out);
int burnish_options_set(burnish_options* options, const char* name, const char* value);
/* Called about ten times a second by the calling thread while burnish_open, burnish_open_meshes, burnish_render, burnish_reference,
 * burnish_set_environment, burnish_set_material or a _told function works with these options. work: its name. done: the share of its
 * current step, 0 to 1; -1 where unknown. Another value than 0 stops the work with 130, unless the work has just ended. NULL: none. */
typedef int (*burnish_progress)(void* user, const char* work, double done);
int burnish_options_progress(burnish_options* options, burnish_progress progress, void* user);
/* A picture as environment, where a function gets these options and NULL as environment: equirectangular, 3 floats a pixel by rows from
 * the top, linear Rec.709 radiance. The pixels are copied. NULL: none. */
int burnish_options_environment(burnish_options* options, const float* pixels, int width, int height);
void burnish_options_free(burnish_options* options);

/* Sessions. scene: path of a .gltf, .glb or .obj file, or "builtin:NAME". environment: path, or "builtin:NAME"; NULL: the scene's own
 * light, else builtin:studio. */
int burnish_open(const char* scene, const char* environment, const burnish_options* options, burnish_session** out);

typedef struct burnish_mesh {
    size_t size;               /* sizeof(burnish_mesh), the same for all of an array */
    const float* positions;    /* 3 a vertex, metres */
    const float* normals;      /* 3 a vertex, none of length 0; NULL: smooth ones are made */
    const float* coordinates;  /* 2 a vertex, (0,0) is the picture's upper left; NULL: none */
    const uint32_t* triangles; /* 3 vertices each, counter-clockwise seen from the front; NULL: vertices in order, a multiple of 3 */
    size_t vertex_count, triangle_count;
    const float* transform;          /* 16, column by column, to world space; NULL: identity */
    const burnish_options* material; /* by names of burnish_material_name; NULL: white, rough, not metallic */
} burnish_mesh;
int burnish_open_meshes(const burnish_mesh* meshes, size_t count, const char* environment, const burnish_options* options,
                        burnish_session** out);
void burnish_close(burnish_session* session);

/* Changes between pictures. Everything that does not depend on them stays: textures, environment, tables. Pictures then have the bits of a
 * new session of the changed scene. A failure changes nothing. Mesh i of burnish_open_meshes has node i and material i. */
int burnish_find_node(const burnish_session* session, const char* name); /* its index; -1: none */
int burnish_find_material(const burnish_session* session, const char* name);
int burnish_find_light(const burnish_session* session, const char* name);
/* Names by index; NULL past the end. They live until the session changes. */
const char* burnish_scene_node(const burnish_session* session, int index);
const char* burnish_scene_material(const burnish_session* session, int index);
const char* burnish_scene_light(const burnish_session* session, int index);
const char* burnish_scene_variant(const burnish_session* session, int index); /* values of the option "variant" */
/* What was repaired or left out while the scene and its environment were read, one line each; NULL past the end. */
const char* burnish_warning(const burnish_session* session, int index);
/* matrix: 16, column by column, to the parent's space. Scenes with a floor refuse it. */
int burnish_set_node(burnish_session* session, int node, const float* matrix);
/* factors: by names of burnish_material_name; others stay as they are. Scenes with a floor refuse it. */
int burnish_set_material(burnish_session* session, int material, const burnish_options* factors);
/* Gives a primitive another material, both by index. Primitive i of burnish_open_meshes is mesh i. Scenes with a floor refuse it. */
int burnish_set_primitive_material(burnish_session* session, int primitive, int material);
/* factors: by names of burnish_light_name, of a point, spot or directional light; others stay as they are. */
int burnish_set_light(burnish_session* session, int light, const burnish_options* factors);
/* environment and options: as burnish_open() takes them. */
int burnish_set_environment(burnish_session* session, const char* environment, const burnish_options* options);

/* Pictures. */
int burnish_render(burnish_session* session, const burnish_options* options, burnish_frame** out);
/* Called like burnish_progress. */
typedef int (*burnish_poll)(void* user);
/* The Monte Carlo reference of the same frame; "samples" counts the samples a pixel. poll may be NULL. */
int burnish_reference(burnish_session* session, const burnish_options* options, burnish_poll poll, void* user, burnish_frame** out);
int burnish_frame_width(const burnish_frame* frame);
int burnish_frame_height(const burnish_frame* frame);
const float* burnish_frame_pixels(const burnish_frame* frame);   /* 3 a pixel by rows from the top, linear Rec.709 radiance */
const float* burnish_frame_variance(const burnish_frame* frame); /* of the reference's means, 3 a pixel; NULL: none */
/* A layer asked for with the option "layers" ("depth", "normal", ...), `channels` values a pixel; NULL: not there. */
const float* burnish_frame_layer(const burnish_frame* frame, const char* name, int* channels);
uint64_t burnish_frame_hash(const burnish_frame* frame); /* over the pixels' bits: equal on every machine */
/* The tone curve of the 8-bit pictures that follow: "none", "pbr-neutral" or "aces". A new frame has pbr-neutral. The option "resolve" of
 * burnish_render chooses the mean of a pixel's samples in these pictures. */
int burnish_frame_tonemap(burnish_frame* frame, const char* name);
/* The picture as screens show it: 8-bit sRGB, red, green, blue and 255 a pixel, by rows from the top. Lives as long as the frame, until the
 * next call. One thread at a time may make one of a frame. exposure_ev: stops, -64 to 64. */
int burnish_frame_rgba8(burnish_frame* frame, float exposure_ev, const unsigned char** pixels);
/* The picture as PNG; the bytes live as long as the frame, until the next call.
 * One thread at a time may make one of a frame. exposure_ev: stops, -64 to 64. */
int burnish_frame_png(burnish_frame* frame, float exposure_ev, const unsigned char** bytes, size_t* size);
int burnish_write(const burnish_frame* frame, const char* path, float exposure_ev); /* by extension: .exr .hdr .pfm .png .jpg .tif */
/* The same two. They tell their progress to the function of the options, which may stop them. A stop leaves no file, or the old one. */
int burnish_frame_png_told(burnish_frame* frame, float exposure_ev, const burnish_options* options, const unsigned char** bytes,
                           size_t* size);
int burnish_write_told(const burnish_frame* frame, const char* path, float exposure_ev, const burnish_options* options);
void burnish_frame_free(burnish_frame* frame);

/* Compares two pictures of floats with 3 channels, linear Rec.709. */
typedef struct burnish_comparison {
    size_t size;                          /* sizeof(burnish_comparison), set by the caller */
    double flip_mean, flip_p99, flip_max; /* HDR-FLIP, [0,1] */
    double mse, rel_mse, max_abs, differing_fraction;
} burnish_comparison;
int burnish_compare(const float* reference, const float* test, int width, int height, burnish_comparison* out);
/* The same. Tells its progress to the function of the options, which may stop it. */
int burnish_compare_told(const float* reference, const float* test, int width, int height, const burnish_options* options,
                         burnish_comparison* out);

#ifdef __cplusplus
}
#endif
