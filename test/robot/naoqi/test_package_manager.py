"""PackageManager: applications of Choregraphe are installed, listed and removed."""

import hashlib
import io
import zipfile

import pytest
from PIL import Image
from simulator import PATIENCE

TURN = """<ChoregrapheProject><Box name="root" id="-1"><Timeline enable="1" fps="10"><ActuatorList>
<ActuatorCurve actuator="HeadYaw" mute="0" unit="0"><Key frame="5" value="20" /></ActuatorCurve></ActuatorList>
</Timeline></Box></ChoregrapheProject>"""
OWN = """<ChoregrapheProject><Box name="root" id="-1"><script><content>self.mine()</content></script></Box>
</ChoregrapheProject>"""
NAMES = '<names><name lang="en_US">Dance</name><name lang="fr_FR">Danse</name></names>'


def png():
    picture = io.BytesIO()
    Image.new("RGB", (16, 16), "red").save(picture, "PNG")
    return picture.getvalue()


@pytest.fixture
def packages(robot):
    return robot.PackageManager


@pytest.fixture
def pack(robot):
    """Writes a package file with these behaviours; returns its path for clients."""

    def write(*behaviors, uuid="dance-1", more="", icon=True):
        contents = "".join(f'<behaviorContent path="{name}"/>' for name in behaviors)
        manifest = f"""<package uuid="{uuid}" version="1.2.0">{NAMES}<supportedLanguages><language>en_US</language>
            </supportedLanguages><contents>{contents}</contents>{more}</package>"""
        with zipfile.ZipFile(robot.server.files.folder / "dance.pkg", "w") as archive:
            archive.writestr("manifest.xml", manifest)
            for name in behaviors:
                archive.writestr(f"{name}/behavior.xar", OWN if name == "own" else TURN)
            if icon:
                archive.writestr("icon.png", png())
        return "/home/nao/dance.pkg"

    return write


def test_a_package_is_installed_told_and_removed_with_its_behaviours(robot, packages, pack):
    installed, added = [], robot.heard("ALBehaviorManager/BehaviorsAdded")
    packages.onPackageInstalled2.connect(installed.append)
    assert packages.install(pack("turn", "turn/back")) is True
    assert added.get(timeout=PATIENCE) == ["dance-1/turn", "dance-1/turn/back"]
    assert packages.hasPackage("dance-1") is True
    package = packages.package2("dance-1")
    assert [package[key] for key in ("uuid", "version", "path")] == ["dance-1", "1.2.0", "/home/nao/dance.pkg"]
    assert package["elems"]["names"] == {"en_US": "Dance", "fr_FR": "Danse"}
    assert package["elems"]["supportedLanguages"] == ["en_US"]
    assert packages.packages2() == packages.packages() == [package]
    robot.advance_until(lambda: installed, 5.0, 0.1, "the package is told")
    assert installed[0]["uuid"] == "dance-1"
    assert ["version", "1.2.0"] in packages.getPackage("dance-1") and len(packages.getPackages()) == 1
    assert bytes(packages.packageIcon("dance-1")) == png() == bytes(packages.getPackageIcon("dance-1"))
    packages.removePkg("dance-1")
    assert packages.packages2() == [] and robot.ALBehaviorManager.getUserBehaviorNames() == []


def test_a_newer_package_replaces_the_one_of_its_uuid(robot, packages, pack):
    removed = robot.heard("ALBehaviorManager/BehaviorRemoved")
    packages.install(pack("turn", "bow"))
    packages.install(pack("turn", "bow/low"))
    assert removed.get(timeout=PATIENCE) == "dance-1/bow"
    assert robot.ALBehaviorManager.getUserBehaviorNames() == ["dance-1/bow/low", "dance-1/turn"]
    assert len(packages.packages2()) == 1


def test_a_package_that_cannot_be_installed_leaves_the_former_one(robot, packages, pack):
    packages.install(pack("turn", uuid="animations"))
    with pytest.raises(RuntimeError, match="behavior is 'animations/Stand/Gestures/Hey_1', allowed is a name that is"):
        packages.install(pack("Stand/Gestures/Hey_1", uuid="animations"))
    robot.settled()
    assert robot.ALBehaviorManager.getUserBehaviorNames() == ["animations/turn"]
    assert len(packages.packages2()) == 1


def test_the_other_behaviours_are_installed_when_one_cannot_be_played(robot, packages, pack, caplog):
    assert packages.install(pack("turn", "own")) is True
    assert robot.ALBehaviorManager.getUserBehaviorNames() == ["dance-1/own", "dance-1/turn"]
    refusal = "own/behavior.xar: 1 of its boxes cannot be played: 'root': a script of its own"
    assert f"dance-1/own is installed with the others, but it fails when it runs: {refusal}" in caplog.text
    with pytest.raises(RuntimeError, match=f"dance-1/own, which is not played: {refusal}"):
        robot.ALBehaviorManager.runBehavior("dance-1/own")
    with pytest.raises(RuntimeError, match="none of its behaviors can be played: own/behavior.xar: 1 of its boxes"):
        packages.install(pack("own", uuid="dance-2"))
    assert not packages.hasPackage("dance-2")


def test_a_sum_is_compared_and_programs_of_a_package_are_not_started(robot, packages, pack, caplog):
    path = pack("turn", more='<services><service name="Daemon" execStart="run"/></services>')
    content = (robot.server.files.folder / "dance.pkg").read_bytes()
    with pytest.raises(RuntimeError, match="installCheckMd5 md5 is '0', allowed is that of"):
        packages.installCheckMd5(path, "0")
    assert packages.hasPackage("dance-1") is False
    assert packages.installCheckMd5(path, hashlib.md5(content).hexdigest()) is True
    assert "Daemon are not started, as they would run on this computer" in caplog.text


def test_a_package_whose_behaviours_were_removed_one_by_one_can_be_removed(robot, packages, pack):
    packages.install(pack("turn"))
    robot.ALBehaviorManager.removeBehavior("dance-1/turn")
    packages.removePkg("dance-1")
    assert packages.hasPackage("dance-1") is False


def test_the_status_of_applications_is_that_of_packages(robot, packages, pack):
    packages.install(pack("turn"))
    (status,) = robot.ALStore.status()
    assert dict(status)["uuid"] == "dance-1" and dict(status)["version"] == "1.2.0"


def test_what_is_no_package_is_refused(packages, pack, robot, refuses):
    (robot.server.files.folder / "text.pkg").write_text("no zip")
    (robot.server.files.folder / "mine.yaml").write_text("behaviors: {}")
    packages.install(pack("turn", icon=False))
    refuses("PackageManager", """
        install('text.pkg') -> text.pkg: is no package
        install('mine.yaml') -> is no package: known are .pkg, .zip
        install('no.pkg') -> no file 'no.pkg'
        removePkg('no') -> unknown package 'no'
        package2('no') -> unknown package 'no'
        packageIcon('dance-1') -> package dance-1 has no icon.png
    """)  # fmt: skip
