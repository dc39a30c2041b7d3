"""layers.py finds every kind of fault: each line below is one file with one fault."""

import pathlib
import sys
import tempfile

import layers

GOOD = {
    "core/base/a.h": "#pragma once\n#include <vector>\n",
    "shading/lang/l.h": "#pragma once\n",
    "shading/kernels/k.k.h": '#ifndef K\n#define K\n#include "shading/lang/l.h"\n',
    "shading/lang/interface.glsl": '#ifndef I\n#define I\n#include "shading/lang/l.h"\n',
    "shading/stages/part.glsl": '#ifndef P\n#define P\n#include "shading/kernels/k.k.h"\n',
    "shading/stages/good.frag": '#version 460\n#include "shading/lang/interface.glsl"\n#include "shading/kernels/k.k.h"\n',
    "shading/stages/alone.vert": "#version 460\n",
    "raster/frame/f.h": '#pragma once\n#include "core/base/a.h"\n',
    "raster/tile/t.cpp": '#include "raster/frame/f.h"\n',
    "raster/tile/t.h": "#pragma once\n",
    "raster/session/s.h": '#pragma once\n#include "raster/tile/t.h"\n',
    "apps/cli/main.cpp": '#include <vector>\n#include "raster/tile/t.h"\n',
    "apps/lab/atlas/a.h": '#pragma once\n#include "raster/tile/t.h"\n',
    "shading/lab/lean/l.frag": "#version 460\n",
    "raster/vulkan/lab/l.h": "#pragma once\n",
    "core/simd/s.h": "#pragma once\n#include <immintrin.h>\n",
    "core/image/io/openimageio_module.cpp": "#include <OpenImageIO/imageio.h>\n",
    "core/image/io/i.cpp": "#include <png.h>\n",
    "core/base/says.cpp": 'const char* kText = "more than a -- dash, a---b, Limits::file_bytes"; // --limit-file-bytes\n',
    "core/scene/s.h": '#pragma once\n#include "core/base/a.h"\n',
    "core/scene/gltf/g.cpp": '#include "core/scene/s.h"\n',
    "apps/report/r.h": '#pragma once\n#include "shading/lang/l.h"\n',
    "apps/chart/c.h": '#pragma once\n#include "apps/report/r.h"\n',
    "shading/bake/b.h": "#pragma once\n",
    "shading/inputs/stage.glsl": "",
    "shading/inputs/frame.h": '#ifndef F\n#define F\n#include "shading/inputs/stage.glsl"\n',
    "apps/cli/says.cpp": 'const char* kText = "--size";\n',
    "tests/unit/x/x_test.cpp": '#include <gtest/gtest.h>\n#include "apps/cli/main.cpp"\n',
    "tests/unit/x/neighbour.cpp": '#include "x_test.cpp"\n',
    "tests/lab/x/x.h": '#pragma once\n#include "raster/vulkan/lab/l.h"\n#include "tests/unit/x/neighbour.cpp"\n',
    "bench/lab/x.cpp": '#include "apps/lab/atlas/a.h"\n',
    "core/math/t.h": "#pragma once\nstruct Twice {\n};\nclass Ahead;\n",
    "core/math/nameless.cpp": "class Ahead;\nnamespace {\nstruct Twice {\n};\n} // namespace\n",
    "CMakeLists.txt": "add_compile_options(-ffp-contract=off)\n",
}
BAD = {
    "raster/frame/twice.cpp": "namespace {\n} // namespace\nstruct Twice {\n};\n",
    "raster/vulkan/drawn_by_lab.cpp": '#include "raster/vulkan/lab/l.h"\n',
    "shading/stages/of_lab.vert": '#include "shading/lab/lean/l.frag"\n',
    "apps/cli/lab.cpp": '#include "apps/lab/atlas/a.h"\n',
    "tests/unit/x/of_lab.cpp": '#include "raster/vulkan/lab/l.h"\n',
    "tests/unit/x/of_lab_test.cpp": '#include "tests/lab/x/x.h"\n',
    "bench/micro/of_lab.cpp": '#include "apps/lab/atlas/a.h"\n',
    "core/base/up.h": '#pragma once\n#include "raster/frame/f.h"\n',
    "core/base/absent.h": '#pragma once\n#include "core/base/absent_too.h"\n',
    "core/base/unguarded.h": "#include <vector>\n",
    "core/base/long.cpp": "int x;\n" * 601,
    "core/base/simd.cpp": "#include <immintrin.h>\n",
    "core/base/cpuid.cpp": "#include <cpuid.h>\n",
    "core/scene/pixels.cpp": "#include <OpenImageIO/imageio.h>\n",
    "core/image/pixels.cpp": "#include <OpenImageIO/imageio.h>\n",
    "core/scene/png.cpp": "#include <png.h>\n",
    "core/image/scene.cpp": "#include <draco/mesh.h>\n",
    "core/image/tasks.cpp": "#include <tbb/parallel_for.h>\n",
    "core/jobs/json.cpp": "#include <ranges>\n",
    "shading/kernels/unguarded.k.h": '#include "shading/lang/l.h"\n',
    "shading/kernels/greedy.k.h": '#pragma once\n#include "core/base/a.h"\n',
    "shading/stages/late.frag": '#include "shading/kernels/k.k.h"\n#include "shading/lang/interface.glsl"\n',
    "shading/stages/never.comp": '#include "shading/stages/part.glsl"\n',
    "shading/bake/up.cpp": '#include "raster/frame/f.h"\n',
    "shading/bake/json.cpp": "#include <nlohmann/json.hpp>\n",
    "raster/vulkan/peek.cpp": '#include "raster/tile/t.h"\n',
    "raster/frame/peek.cpp": '#include "raster/tile/t.h"\n',
    "raster/frame/session.cpp": '#include "raster/session/s.h"\n',
    "raster/tile/vk.cpp": "#include <vulkan/vulkan.h>\n",
    "raster/tile/ticks.cpp": "auto t = __rdts" + "c();\n",
    "raster/tile/relative.cpp": '#include "../frame/f.h"\n',
    "raster/tile/sloppy.cpp": "#pragma GCC optimize(\"ffast" + "-math\")\n",
    "raster/tile/approximate.cpp": "auto x = _mm256_rsq" + "rt_ps(y);\n",
    "raster/tile/approximate14.cpp": "auto x = _mm512_rc" + "p14_ps(y);\n",
    "raster/tile/unfinished.cpp": "// TO" + "DO: later\n",
    "raster/tile/dead.cpp": "#if " + "0\n#endif\n",
    "tests/unit/x/absent.cpp": '#include "y_test.cpp"\n',
    "apps/cli/neighbour.cpp": '#include "main.cpp"\n',
    "apps/here.cpp": 'const char* path = "/wo' + 'rk/data";\n',
    "apps/utils.cpp": "\n",
    "core/base/room.cpp": '#include "core/scene/s.h"\n',
    "core/jobs/room.cpp": '#include "core/simd/s.h"\n#include "core/scene/s.h"\n',
    "core/novel/room.cpp": "\n",
    "shading/lang/room.h": '#ifndef R\n#define R\n#include "shading/kernels/k.k.h"\n',
    "shading/lang/stage.h": '#ifndef S\n#define S\n#include "shading/inputs/stage.glsl"\n',
    "shading/stages/room.glsl": '#include "shading/bake/b.h"\n',
    "apps/report/room.cpp": '#include "apps/chart/c.h"\n',
    "core/base/option.cpp": 'Error wrong() { return {"--size"}; }\n',
    "shading/option.def": 'LINE(a, "of \\"b\\", --samples many")\n',
    "raster/frame/option.cpp": 'const char* kText = "x (--brdf)";\n',
    "core/base/net.h": "#pragma once\nnamespace mipnet {\nstruct Weights;\n}\n",
    "core/base/filter.h": "#pragma once\nenum class MipFilter : int;\n",
    "core/base/levels.h": "#pragma once\nstruct MipFile;\n",
    "notes.txt": "\n",
}


def write(root, files):
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    write(root, GOOD)
    wrong = [f"a good tree is refused: {fault}" for fault in layers.faults(root)]
    write(root, BAD)
    found = {str(fault[0]) for fault in layers.faults(root)}
    wrong += [f"not found: {name}" for name in BAD if name not in found]
    wrong += [f"refused without reason: {name}" for name in found if name not in BAD]
for line in wrong:
    print(line)
sys.exit(1 if wrong else 0)
