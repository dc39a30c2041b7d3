"""Typical mistakes: each is answered with one helpful line, and nothing is written. The case leaves their table as mistakes.md in its
folder below build/release/tests/cli."""

from harness import case, check, scratch

# Typed words, exit code, and text that the message must contain.
MISTAKES = (
    ("rendr", 2, "did you mean 'render'?"),
    ("teapot", 2, "the built-in scene is called builtin:teapot"),
    ("lamp.glb", 4, "lamp.glb: cannot be opened"),
    ("help rendre", 2, "did you mean 'render'?"),
    ("list technique", 2, "did you mean 'techniques'?"),
    ("render --techniqe major_axis", 2, "did you mean '--technique'?"),
    ("render --outptu a.png", 2, "did you mean '--output'?"),
    ("render --technique major-axis", 2, "did you mean 'major_axis'?"),
    ("render --technique weighted", 2, "did you mean 'major_axis_weighted'?"),
    ("render --tonemap pbr", 2, "did you mean 'pbr-neutral'?"),
    ("render builtin:teapto", 2, "did you mean 'builtin:teapot'?"),
    ("render --env builtin:studoi", 2, "did you mean 'builtin:studio'?"),
    ("render teapot", 4, "builtin:teapot"),
    ("render Spheres", 4, "builtin:spheres"),
    ("render --env studio", 4, "builtin:studio"),
    ("render --env https://example.org/workshop.hdr", 4, "download it first"),
    ("render https://example.org/lamp.glb", 4, "download it first"),
    ("render chair.fbx", 4, "scenes are .gltf, .glb or .obj files"),
    ("render chair.obj", 4, "chair.obj: cannot be opened: No such file or directory"),
    ("render teapot.png", 4, "-o teapot.png"),
    ("render workshop.hdr --env builtin:sky", 4, "--env workshop.hdr"),
    ("render --env lamp.glb", 4, "burnish render lamp.glb"),
    ("render lamp.glb -o a.png", 4, "lamp.glb: cannot be opened"),
    ("render --size 1280", 2, "1280x720"),
    ("render --size 1280*720", 2, "1280x720"),
    ("render --eye 1 2 3", 2, "--eye takes X,Y,Z, with commas"),
    ("render --fov 400", 2, "0.1 to 179"),
    ("render --roughness 40", 2, "0 to 1"),
    ("render --msaa 3", 2, "1, 2, 4, 8, 16"),
    ("render --samples 0", 2, "--samples"),
    ("render --device lavapipe", 2, "needs --backend vulkan"),
    ("render --backend gpu", 2, "--backend vulkan --device gpu"),
    ("render --backend cpu", 2, "tile is the renderer on the CPU"),
    ("render --backend metal", 2, "tile, vulkan, reference"),
    ("render --brdf ward", 2, "--technique mc"),
    ("render --aov depht -o a.exr", 2, "did you mean 'depth'?"),
    ("render --aov depth,normal,depth -o a.exr", 2, "is given twice"),
    ("render --aov depth -o a.png", 2, "needs -o FILE.exr"),
    ("render --height-scale 2", 2, "nothing in the scene has a height map"),
    ("render --height-map heights.png builtin:spheres", 4, "heights.png: cannot be opened"),
    ("render --light sphere:points=0,1,0", 2, "radiance=R,G,B"),
    ("render -o a.png -o a.png", 2, "twice"),
    ("render -o picture.bmp", 2, "png"),
    ("render -o", 2, "--output: 1 required FILE missing"),
    ("render -o no/such/folder/a.png", 7, "no/such/folder"),
    ("compare a.png", 2, "TEST is required"),
    ("compare a.png b.png", 4, "a.png: cannot be opened"),
    ("chart", 2, "--output is required"),
    ("bake", 2, "direction, quaternion, tpr, displaced, lobe, half-vectors, brdf-lut, environment or mip"),
    ("chart --techniques major -o report", 2, "did you mean 'major_axis'?"),
    ("profile --aov depth -o a.exr", 2, "belongs to burnish render"),
)


@case("usage.typical_mistakes_are_answered_with_what_helps")
def mistakes(bench):
    small = ("--size", "16x16", "--env-size", "16", "--env-samples", "1", "--no-cache", "-q")
    wrong = []
    rows = ["| typed | exit code | answer |", "| --- | --- | --- |"]
    for typed, code, needle in MISTAKES:
        done = bench.run(*typed.split(), *(small if code == 7 or "--height-scale" in typed else ()))
        line = done.err.strip()
        rows.append(f"| `burnish {typed}` | {done.code} | {line.replace('|', chr(92) + '|')} |")
        if done.code != code or needle not in line or "\n" in line or done.out:
            wrong.append(f"burnish {typed}: wanted exit code {code} and {needle!r}, got {done.code} and {line!r}, and {done.out!r}")
        if bench.left_behind():
            wrong.append(f"burnish {typed}: files were left: {bench.left_behind()}")
    scratch(bench, "mistakes.md", "\n".join(rows) + "\n")
    check(not wrong, "\n".join(wrong))


@case("usage.what_a_scene_cannot_do_is_refused_before_its_environment_is_baked")
def before_the_bake(bench):
    for words, needle in ((("--height-scale", "2"), "height map"), (("--camera", "nothing"), "--camera"),
                          (("--animate", "height-scale=2:3", "--steps", "2", "-o", "%d.png"), "height map")):
        done = bench.run("render", "builtin:plate", "--size", "16x16", "--env-size", "16", "--env-samples", "1", "--no-cache", *words).expect(2)
        check(needle in done.err and "environment" not in done.err, f"refused after the bake\n{done.describe()}")


@case("usage.what_is_far_from_every_name_gets_no_guess")
def no_guess(bench):
    for words in (("frobnicate",), ("render", "--bogus"), ("render", "--technique", "nothing"), ("render", "nowhere.glb"), ("render", "x")):
        done = bench.run(*words)
        check(done.code != 0 and "did you mean" not in done.err and "called builtin" not in done.err, done.describe())
