"""Numbers of participants where their file is anything: nobody gets one twice, so nothing is begun anew."""

import pytest

from nao_library_modules.studies.study_files import PARTICIPANTS, StudyFiles
from naoqi.errors import NaoError


@pytest.mark.parametrize("content", [b"\xff\xfe", b"{P01: 1", b"{P01: .inf}", b"{P01: true}", b"[P01]", b"[" * 9999])
def test_numbers_that_cannot_be_read_are_refused_and_stay(tmp_path, content):
    path = tmp_path / "greeting" / PARTICIPANTS
    path.parent.mkdir()
    path.write_bytes(content)
    with pytest.raises(NaoError, match=PARTICIPANTS):
        StudyFiles(tmp_path).number_of("greeting", "P02")
    assert path.read_bytes() == content
