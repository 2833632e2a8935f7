"""Files that people have, good, odd and broken: the right answer for each of them.

Most hold the same 30 points. A row of the table gives what a file must be read as, made from these points, or
the sentence that must come instead; no file is left out, and no row of a file is lost without a word.
"""

from pathlib import Path

import numpy as np
import pytest

from dt3d.files import read_points

FOLDER = Path(__file__).parents[3] / "shared" / "cases" / "files"
UTM = [500_000.123, 4_600_000.456, 100]


def same(points):
    return points


def single(points):
    """What the file holds is float32 in bytes; numbers that are written out are read as they are written."""
    return points.astype(np.float32).astype(np.float64)


def corners(points):
    """Three triangles of a binary STL file, each corner once."""
    return single(points[:9])


def far(points):
    return points + UTM


def flat(points):
    return np.random.default_rng(0).random((50, 3)) * [1, 1, 0]


def lattice(size):
    """The points of an image of VTK: x runs first."""
    return np.array([[x, y, z] for z in range(size) for y in range(size) for x in range(size)], float)


UNKNOWN = "unknown extension"
TABLE = {
    "ansys.csv": same,
    "ansys4.csv": same,
    "ascii.stl": lambda points: points[:9],
    "ascii_xyz_chem.xyz": same,
    "bin.stl": corners,
    "bom.csv": same,
    "broken.vtu": r"broken\.vtu",
    "cloudcompare_header.txt": same,
    "cloudcompare_header_space.asc": same,
    "cloudcompare_header_space.txt": same,
    # the first of six columns may be anything, and the message says how to name them
    "cloudcompare_plain.txt": "found 6 columns; expected three, or a header .* '# x y z c4 c5 c6'",
    "comma.xyz": same,
    "comma_space.csv": same,
    "count_then_rows.txt": same,
    "count_then_rows.xyz": same,
    "cr_only.csv": same,
    "crlf.csv": same,
    "double_slash.txt": same,
    "dup_header.csv": r"columns 1 \(x\), 4 \(x\) the coordinate x; rename all but one",
    "empty.csv": "is empty",
    "empty.vtp": r"empty\.vtp holds no points",
    "excel_semicolon_decimal_comma.csv": same,
    "exclam.txt": same,
    "extxyz.xyz": same,
    "extxyz_pos_last.xyz": same,
    "f4.vtk": single,
    "first_row_NA.txt": r"line 1, column 2: a value is missing \('NA'\)",
    "first_row_dash.csv": r"line 1, column 3: a value is missing \('-'\)",
    "first_row_missing_value.csv": "line 1, column 2: a value is missing",
    "flat.csv": flat,
    "fortran_D.txt": same,
    "geo.csv": same,
    "geo4.csv": same,
    "german_spaces.txt": same,
    "german_tab.txt": same,
    "german_tab_header.txt": same,
    "gz.csv.gz": same,
    "hash_comment_mid.csv": lambda points: np.concatenate([points[:11], points]),
    "header.xyz": same,
    "id_header.csv": same,
    "image.vti": lambda points: lattice(3),
    "indent.obj": same,
    "json.json": UNKNOWN,
    "json_in.txt": r"line 1, column 1: '\[\[0' is not a number",
    # seven columns, as for six
    "kitti7.txt": "found 7 columns; expected three, or a header .* '# x y z c4 c5 c6 c7'",
    "lammps.dump": same,
    "leica.pts": same,
    "lonlat.csv": same,
    "lower_atom.pdb": same,
    "m.vtm": r"m\.vtm",
    "meshlab.xyz": same,
    "mid_row_missing.csv": "line 31, column 2: a value is missing",
    "missing_last_column.csv": "line 32: 2 columns where 3 are expected",
    "mixedfaces.off": same,
    "model.pdb": lambda points: np.concatenate([points, points]),
    "noext": UNKNOWN,
    "noheader.off": same,
    "npy_0d.npy": r"found \(\)",
    "npy_3n.npy": r"found \(3, 30\); transpose it",
    "npy_F.npy": same,
    "npy_be.npy": same,
    "npy_f16.npy": same,
    "npy_f4.npy": single,
    "npy_i8.npy": lambda points: np.trunc(points * 1000),
    "npy_i8_big.npy": "9007199254740993.*float64 does not hold exactly",
    "npy_masked.npy": same,  # the mask is not in the file
    "npy_n2.npy": lambda points: points[:, :2],
    "npy_n4.npy": r"found \(30, 4\)",
    "npy_nan.npy": lambda points: np.load(FOLDER / "npy_nan.npy"),  # the triangulation names the row
    "npy_object.npy": "holds Python objects",
    "npy_structured.npy": same,
    "npy_structured_rgb.npy": single,
    "npz_arr0.npz": "arr_0, arr_1",
    "npz_mesh.npz": same,
    "npz_one.npz": same,
    "npz_points_and.npz": same,
    "npz_pos.npz": same,
    "npz_xyz.npz": same,
    "ok.pdb": same,
    "oneline.off": same,
    "only_header.csv": "has a header but no rows",
    "p.off": same,
    "pandas_default.csv": same,
    "pandas_index.csv": same,
    "pandas_noindex_default.csv": "line 1: 0,1,2 may be a header .* or a point",
    "paraview.csv": same,
    "paraview_data_first.csv": same,
    "paraview_new.csv": same,
    "pcd.pcd": same,
    "percent_comment.txt": same,
    "ply_ascii.ply": same,
    "ply_be.ply": single,
    "ply_bunny_conf.ply": same,
    "ply_camera_first.ply": same,
    "ply_camera_last.ply": same,
    "ply_cloudcompare_objinfo.ply": same,
    "ply_cloudcompare_objinfo_bin.ply": single,
    "ply_crlf.ply": same,
    "ply_double_utm.ply": far,
    "ply_empty.ply": r"ply_empty\.ply",
    "ply_faces.ply": single,
    "ply_gaussian_splat.ply": single,
    "ply_le.ply": single,
    "ply_normals_first.ply": single,
    "ply_quads.ply": same,
    "ply_rgb.ply": single,
    "ply_truncated.ply": r"ply_truncated\.ply",
    "ply_vertex_list.ply": single,
    "ply_vertex_list_ascii.ply": same,
    "polar.obj": same,
    "qhull.txt": same,
    "quad.off": same,
    "quoted.csv": same,
    "s.vts": lambda points: lattice(2)[:, [1, 0, 2]],
    "scipy.vtu": lambda points: np.random.default_rng(0).random((50, 3)),
    "serial_100000_shifted.pdb": same,
    "single.csv": lambda points: np.array([[1.0, 2.0, 3.0]]),
    "solid_bin.stl": corners,
    "spaces_in_header_semicolon.csv": same,
    "surfer_gap.dat": same,
    "tabbed.pdb": r"line 1: an atom's coordinates \(columns 31 to 54\) are not numbers",
    "tabs.tsv": same,
    "tetgen.node": same,
    "text_renamed.npy": r"text_renamed\.npy is not a NumPy array file",
    "text_with_preamble.txt": "line 1, column 1: 'Exported' is not a number; lines of text .* start with '#'",
    "thousands.csv": "line 2, column 1: '1,234.5' has a comma within",
    "tinker_shift.pdb": lambda points: np.full((4, 3), [136.582, 148.529, 157.436]),
    "trailing_comma.csv": same,
    "trailing_comma_header.csv": same,
    "two_columns.csv": lambda points: points[:, :2],
    "utf16_excel.txt": same,
    "utm.vtp": far,
    "v_colors.obj": same,
    "v_w.obj": same,
    "vectors.csv": r"line 1, column 1: '\[1\.0' is not a number",
    "vmd_hex.pdb": same,
    "vt_first.obj": same,
    "x.cif": same,
    "x_y_z_reordered.csv": lambda points: points[:, ::-1],
    "xy_header.csv": lambda points: points[:, :2],
    "xyz.bin": UNKNOWN,
    "xyz_blank_comment_missing.xyz": same,
    "xyz_chem_multi.xyz": "several frames must be split first",
    "xyz_header_in_hash_later.txt": same,
    "xyz_labels.xyz": same,
    "xyz_upper_extra.csv": same,
    "zip_empty.npz": r"zip_empty\.npz",
}


@pytest.fixture
def folder():
    if not FOLDER.is_dir():
        pytest.skip(f"the files are not at {FOLDER}")
    return FOLDER


@pytest.mark.parametrize("name", TABLE)
def test_each_file_is_read_whole_or_refused_by_its_sentence(folder, name, capfd):
    right = TABLE[name]
    if isinstance(right, str):
        with pytest.raises((ValueError, OSError), match=right) as error:
            read_points(folder / name, dimension=None)
        assert "\n" not in str(error.value)
        assert name in str(error.value)
    else:
        found = read_points(folder / name, dimension=None)
        assert found.dtype == np.float64
        # read by NumPy alone, from three columns between blanks
        np.testing.assert_array_equal(found, right(np.loadtxt(folder / "noext")))
    assert capfd.readouterr().err == ""


def test_no_file_is_left_out(folder):
    assert sorted(path.name for path in folder.iterdir()) == sorted(TABLE)
