"""Lists the cases, or runs one: exit code 0 passed, 1 failed, 77 skipped."""

import argparse
import pathlib
import sys

import animation_cases
import atlas_cases
import bake_cases
import blend_cases
import brdf_cases
import budget_cases
import camera_cases
import chart_cases
import chart_page_cases
import coat_cases
import compare_cases
import compare_many_cases
import confine_cases
import cycles_cases
import detail_cases
import direction_cases
import energy_cases
import export_cases
import far_cases
import fault_cases
import file_cases
import fresnel_cases
import glass_cases
import golden_cases
import harness
import hostile_cases
import image_light_cases
import input_cases
import install_cases
import kill_cases
import jump_cases
import key_light_cases
import law_cases
import layer_cases
import light_cases
import limit_cases
import manual_cases
import manual_page_cases
import mip_cases
import mip_file_cases
import mip_light_cases
import mip_zoom_cases
import mistake_cases
import model_cases
import output_cases
import outside_cases
import parity_cases
import phong_cases
import pixel_cases
import processor_cases
import python_cases
import python_more_cases
import python_offscreen_cases
import reading_cases
import plot_cases
import profile_cases
import progress_cases
import reference_cases
import relief_cases
import risk_cases
import subcommand_cases
import tilt_cases
import train_cases
import usage_cases
import wide_lobe_cases

parser = argparse.ArgumentParser()
parser.add_argument("--program", default="")
parser.add_argument("--compare-program", default="")
parser.add_argument("--data", required=True, action="append", type=pathlib.Path, help="test data; of two files of a name the first counts")
parser.add_argument("--work", default="")
parser.add_argument("--sanitized", action="store_true")
parser.add_argument("--list", action="store_true")
parser.add_argument("case", nargs="?")
arguments = parser.parse_args()

input_cases.add_data_cases(arguments.data)
model_cases.add_data_cases(arguments.data)
if arguments.list:
    for name, (_, labels) in harness.CASES.items():
        print(name, ",".join(labels))
    sys.exit(0)

bench = harness.Bench(arguments.program, arguments.compare_program, arguments.data, arguments.work, arguments.sanitized)
bench.open(arguments.case)
try:
    harness.CASES[arguments.case][0](bench)
except harness.Skipped as reason:
    print("skipped:", reason)
    sys.exit(77)
except harness.Failed as reason:
    print("failed:", reason)
    sys.exit(1)
