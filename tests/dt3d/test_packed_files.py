"""Files that gzip has packed: any format inside, and what is damaged or would not fit."""

import gzip
import tempfile

import numpy as np
import pytest

from dt3d.files import read_points
from dt3d.reading import compressed

POINTS = np.array([[0.1, 1 / 3, -2.5], [1e-7, 2.0, 3.0000000001], [-1.0, 0.0, 1e5 / 7], [4.0, 5.0, 6.0]])
ROWS = "".join(f"{x!r},{y!r},{z!r}\n" for x, y, z in POINTS.tolist())


def pack(path, content):
    with gzip.open(path, "wb") as file:
        file.write(content)
    return path


def test_any_format_may_be_packed(tmp_path):
    np.save(tmp_path / "plain.npy", POINTS)
    packed = pack(tmp_path / "a.npy.gz", (tmp_path / "plain.npy").read_bytes())
    np.testing.assert_array_equal(read_points(packed), POINTS)
    np.testing.assert_array_equal(read_points(pack(tmp_path / "a.CSV.GZ", ROWS.encode())), POINTS)


def test_errors_name_the_packed_file_and_nothing_stays_behind(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    path = pack(tmp_path / "a.csv.gz", b"1,2,3\n4,five,6\n")
    with pytest.raises(ValueError, match="five") as caught:
        read_points(path)
    assert str(path) in str(caught.value)
    assert "temporary" not in str(caught.value)
    assert not list((tmp_path / "temporary").iterdir())


@pytest.mark.parametrize("kept", [0.0, 0.2, 0.5, 0.9, 0.99])
def test_a_packed_file_that_is_cut_off_is_an_error(tmp_path, kept):
    whole = pack(tmp_path / "a.csv.gz", ROWS.encode()).read_bytes()
    path = tmp_path / "b.csv.gz"
    path.write_bytes(whole[: int(kept * len(whole))])
    with pytest.raises(ValueError, match=r"b\.csv\.gz (is no whole gzip file|is empty)"):
        read_points(path)


def test_a_packed_file_whose_checksum_is_wrong_is_an_error(tmp_path):
    content = bytearray(pack(tmp_path / "a.csv.gz", ROWS.encode()).read_bytes())
    content[-6] ^= 1
    (tmp_path / "b.csv.gz").write_bytes(content)
    with pytest.raises(ValueError, match=r"b\.csv\.gz is no whole gzip file: CRC check failed"):
        read_points(tmp_path / "b.csv.gz")


def test_a_few_kilobytes_that_stand_for_gigabytes_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(compressed, "available_memory", lambda: 10 << 20)
    path = pack(tmp_path / "a.csv.gz", bytes(6 << 20))
    with pytest.raises(ValueError, match=r"unpacks to more than the 5\.2 MB that there is room"):
        read_points(path)


def test_the_extension_inside_must_be_known(tmp_path):
    with pytest.raises(ValueError, match=r"unknown extension '\.tar'"):
        read_points(tmp_path / "a.tar.gz")
