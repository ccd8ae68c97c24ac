"""Write the profile files that come with the package from their formulas: profiles/*.txt."""

from pathlib import Path

from exudyn_wheelset.profiles import save_profile, shapes
from exudyn_wheelset.profiles.profile import Profile


def bundled_profiles() -> dict[str, Profile]:
    """The shapes that have a file, by the file's stem."""
    return {
        "S1002": shapes.s1002(),
        "UIC60": shapes.uic60(),
        "AAR_1_20": shapes.aar_1_20(),
        "cone_1_20": shapes.cone(0.05),
        "knife_edge": shapes.knife_edge(),
    }


def main() -> None:
    folder = Path(__file__).resolve().parents[1] / "profiles"
    for stem, profile in bundled_profiles().items():
        print(save_profile(profile, folder / f"{stem}.txt"))


if __name__ == "__main__":
    main()
