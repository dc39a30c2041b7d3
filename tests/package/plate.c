/* Draws a brushed plate made of arrays, through the C interface. Prints the hashes of two pictures, then the words of three errors. */
#include <burnish/burnish.h>
#include <stdio.h>

static int polls(void* count)
{
    return ++*(int*)count > 1; /* stops at the second call */
}

static int stops(void* user, const char* work, double done)
{
    (void)user, (void)done;
    return work != NULL;
}

static int fail(const char* what, int code)
{
    fprintf(stderr, "%s: %d: %s\n", what, code, burnish_error());
    return 1;
}

int main(void)
{
    const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    const float coordinates[] = {0, 1, 1, 1, 1, 0, 0, 0};
    const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    burnish_options *material, *options;
    burnish_session *session, *again;
    burnish_frame *frame, *other;
    burnish_mesh mesh = {sizeof(burnish_mesh), positions, NULL, coordinates, triangles, 4, 2, NULL, NULL};
    burnish_comparison figures = {sizeof(burnish_comparison), 0, 0, 0, 0, 0, 0, 0};
    const unsigned char* png;
    size_t size;
    int code, count = 0, channels = 0;
    if (burnish_api_version() != BURNISH_API_VERSION || burnish_options_make(&material) || burnish_options_make(&options))
        return 1;
    if (burnish_options_set(material, "roughness", "0.4") || burnish_options_set(material, "anisotropy_strength", "0.8") ||
        burnish_options_set(material, "metallic", "1"))
        return fail("material", 0);
    if (burnish_options_set(options, "width", "96") || burnish_options_set(options, "height", "64") ||
        burnish_options_set(options, "env-size", "32") || burnish_options_set(options, "env_samples", "16") ||
        burnish_options_set(options, "layers", "depth,normal") || burnish_options_set(options, "fov", "40"))
        return fail("options", 0);
    mesh.material = material;
    if ((code = burnish_open_meshes(&mesh, 1, NULL, options, &session)) || (code = burnish_open("builtin:spheres", NULL, options, &again)))
        return fail("open", code);
    if ((code = burnish_render(session, options, &frame)) || (code = burnish_render(again, options, &other)))
        return fail("render", code);
    if (burnish_frame_width(frame) != 96 || burnish_frame_height(frame) != 64 || !burnish_frame_layer(frame, "normal", &channels) || channels != 3)
        return fail("layers", channels);
    printf("%016llx\n%016llx\n", (unsigned long long)burnish_frame_hash(frame), (unsigned long long)burnish_frame_hash(other));
    if ((code = burnish_compare(burnish_frame_pixels(frame), burnish_frame_pixels(other), 96, 64, &figures)) || !(figures.flip_mean > 0.0))
        return fail("compare", code);
    if ((code = burnish_frame_png(frame, 0.0f, &png, &size)) || size < 8 || png[1] != 'P')
        return fail("png", code);
    /* Pixels for screens: black 64 stops below, full above wherever there is light */
    if (burnish_frame_tonemap(frame, "none") || burnish_frame_rgba8(frame, -65.0f, &png) != 2 || burnish_frame_rgba8(frame, 0.0f, NULL) != 2 ||
        burnish_frame_rgba8(NULL, 0.0f, &png) != 2)
        return fail("rgba8 of nothing", 0);
    for (int stops = -64; stops <= 64; stops += 128) {
        if ((code = burnish_frame_rgba8(frame, (float)stops, &png)))
            return fail("rgba8", code);
        for (int i = 0; i < 4 * 96 * 64; ++i)
            if (png[i] != (i % 4 == 3 || (stops > 0 && burnish_frame_pixels(frame)[i / 4 * 3 + i % 4] > 0.0f) ? 255 : 0))
                return fail("a value of rgba8", i);
    }
    burnish_frame_tonemap(frame, "pbr-neutral");
    if ((code = burnish_write(frame, "plate.png", 0.0f)))
        return fail("write", code);
    /* Failures say why, and end nothing */
    if (burnish_options_set(options, "widht", "1") != 2)
        return fail("an unknown option", 0);
    printf("%s\n", burnish_error());
    mesh.vertex_count = 3;
    if (burnish_open_meshes(&mesh, 1, NULL, options, &session) != 4)
        return fail("an index beyond", 0);
    printf("%s\n", burnish_error());
    if (burnish_open("absent.glb", NULL, NULL, &again) != 4)
        return fail("a missing file", 0);
    printf("%s\n", burnish_error());
    if (burnish_render(NULL, NULL, &frame) != 2 || burnish_compare(NULL, NULL, 1, 1, &figures) != 2 || burnish_open(NULL, NULL, NULL, NULL) != 2)
        return fail("NULL", 0);
    /* Values are checked where they are given; each option belongs to some functions */
    if (burnish_options_set(options, "width", "-5") != 2 || burnish_options_set(material, "metallic", "2") != 2 || burnish_option_calls(-1) != 0 ||
        burnish_option_calls(0) != (BURNISH_RENDER | BURNISH_REFERENCE) || !burnish_option_values(0) || burnish_option_default(10000) ||
        burnish_render(session, material, &frame) != 2)
        return fail("options", 0);
    mesh.triangles = NULL, mesh.vertex_count = 4;
    if (burnish_open_meshes(&mesh, 1, NULL, options, &session) != 2)
        return fail("4 vertices in order", 0);
    if (burnish_set_primitive_material(session, 0, 0) || burnish_set_primitive_material(session, 1, 0) != 2 || burnish_frame_tonemap(frame, "film") != 2 ||
        burnish_frame_tonemap(frame, "aces") || burnish_frame_png(frame, 0.0f, &png, &size))
        return fail("materials and tones", 0);
    /* Changes between pictures: there and back gives the first picture's bits */
    {
        const float away[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.3f, 0, 0, 1}, home[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        const float sky[2 * 4 * 3] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
        const uint64_t first = burnish_frame_hash(frame);
        burnish_frame* moved;
        burnish_frame* back;
        if (burnish_options_set(options, "eye", "0,0,4") || burnish_options_set(options, "target", "0,0,0") ||
            (code = burnish_render(session, options, &back)))
            return fail("a view", code);
        burnish_frame_free(frame), frame = back;
        if ((code = burnish_set_node(session, 0, away)) || (code = burnish_render(session, options, &moved)))
            return fail("a moved node", code);
        if (burnish_frame_hash(moved) == burnish_frame_hash(frame) || first == burnish_frame_hash(frame))
            return fail("the same picture", 0);
        burnish_frame_free(moved);
        if ((code = burnish_set_node(session, 0, home)) || (code = burnish_set_material(session, 0, material)) ||
            (code = burnish_render(session, options, &back)) || burnish_frame_hash(back) != burnish_frame_hash(frame))
            return fail("back again", code);
        burnish_frame_free(back);
        if (burnish_set_node(session, 7, home) != 2 || burnish_set_light(session, 0, NULL) != 2 || burnish_find_node(session, "none") != -1 ||
            burnish_set_material(session, 0, options) != 2)
            return fail("what is not there", 0);
        if (burnish_options_environment(options, sky, 0, 2) != 2 || burnish_options_environment(options, sky, 4, 2) ||
            (code = burnish_set_environment(session, NULL, options)) || (code = burnish_render(session, options, &back)) ||
            burnish_frame_hash(back) == burnish_frame_hash(frame))
            return fail("an environment in memory", code);
        burnish_frame_free(back), burnish_options_free(options);
        if (burnish_options_make(&options) || burnish_options_progress(options, stops, NULL) ||
            burnish_options_set(options, "technique", "mc") || burnish_options_set(options, "samples", "4096") ||
            (code = burnish_render(session, options, &back)) != 130)
            return fail("a stopped picture", code);
    }
    burnish_options_free(options);
    if (burnish_options_make(&options) || burnish_options_set(options, "samples", "1000000") || burnish_options_set(options, "width", "200") ||
        burnish_options_set(options, "height", "200"))
        return 1;
    code = burnish_reference(session, options, polls, &count, &frame);
    if (code != 130 && code != 77) /* 77: built without Embree */
        return fail("a stopped reference", code);
    burnish_options_free(options), burnish_options_free(material), burnish_options_free(NULL);
    burnish_frame_free(frame), burnish_frame_free(other), burnish_close(session), burnish_close(again);
    return 0;
}
