"""Groups of mutation_run.py for vehicles, systems of equations and analyses of stability.

Tests of a group run in seconds, those that notice most first; what takes longer is deselected.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Group:
    """Modules and the tests that are to notice.

    compiled: False runs the kernels as Python, which saves compiling every mutant; deselected:
    tests left out (an expression of pytest's -k), for their time.
    """

    modules: tuple[str, ...]
    tests: tuple[str, ...]
    compiled: bool = True
    deselected: str = ""


def _under(folder: str, names: str) -> tuple[str, ...]:
    return tuple(f"{folder}/{name}.py" for name in names.split())


_ELEMENT_TESTS = (
    "test_vehicle_elements.py",
    "test_wedge_and_plate_equilibrium.py",
    "test_friction_loops_closed_form.py",
)
_VEHICLE_TESTS = (
    "test_vehicle_statics.py",
    "test_manchester_coach_by_hand.py",
    "test_dtu_car_17_degrees.py",
    "test_vehicle_description.py",
    "test_vehicle_motion.py",
)

UPPER_GROUPS = {
    "vehicle-kernel": Group(
        _under("systems", "vehicle_kernel vehicle_system compiled_vehicle"),
        (
            "test_shares_of_a_curve.py",
            "test_compiled_vehicle_against_exudyn.py",
            "test_simulate.py",
            "test_random_vehicles.py",
        ),
        deselected="result_or_an_error",
    ),
    "exudyn": Group(
        _under(
            "systems",
            "axisymmetry exudyn_layout exudyn_running exudyn_system exudyn_wheelsets system",
        ),
        (
            "test_starts_and_runaways.py",
            "test_linearisation_gyroscope.py",
            "test_registered_wheelsets.py",
            "test_linearisation_closed_forms.py",
            "test_simulate.py",
            "test_linearisation_rolling_cone.py",
        ),
    ),
    "constraints": Group(
        _under("systems", "constraints"),
        ("test_joints_in_small_steps.py", "test_joints.py"),
        deselected="limit_cycles",
    ),
    "curving": Group(
        _under("systems", "curving steady_curve"),
        (
            "test_shares_of_a_curve.py",
            "test_curving_closed_forms.py",
            "test_rails_at_rest.py",
        ),
        deselected="newtons_method or simulated_curve or halving or coach_in_a_narrow",
    ),
    "simulation": Group(
        _under("systems", "simulation starts trucks checks"),
        (
            "test_starts_and_runaways.py",
            "test_simulate.py",
            "test_modes_and_windows.py",
            "test_vehicle_motion.py",
        ),
    ),
    "connection-kernel": Group(
        _under("vehicles", "kernel frames friction_kernel links"),
        ("test_pieces_of_the_connections.py", "test_drawn_links.py", *_ELEMENT_TESTS),
        compiled=False,
        deselected="complex_stiffness or tables_are or loop_of or loading_and_unloading[600000",
    ),
    "elements": Group(
        _under(
            "vehicles/elements",
            "air_spring anti_roll_bar axle_box bump_stop centre_plate coil_nest coil_spring curve "
            "damper friction friction_damper friction_wedge leaf_spring link_suspension protocol "
            "side_bearer spring traction_rod",
        ),
        (*_ELEMENT_TESTS, "test_vehicle_statics.py"),
        deselected="complex_stiffness or loop_of_a_loaded",
    ),
    "statics": Group(
        _under("vehicles", "balance statics rest rail_support struts layout"),
        ("test_bounds_of_vehicle_files.py", *_VEHICLE_TESTS, "test_vehicle_elements.py"),
        deselected="complex_stiffness",
    ),
    "description": Group(
        _under("vehicles", "description builder paths assemble spin_drive drawbar"),
        ("test_vehicle_description.py", "test_vehicle_motion.py", "test_vehicle_statics.py"),
        deselected="several_vehicles or no_rest",
    ),
    "vehicle-files": Group(
        _under(
            "vehicles/files",
            "converting element_types lines reading track_entries units writing",
        ),
        ("test_bounds_of_vehicle_files.py", "test_vehicle_files.py"),
    ),
    "orbits": Group(
        _under(
            "stability/hunting",
            "collocation corrector floquet orbit continuation continuation_settings folds "
            "fold_points corners branch symmetry limit_cycles",
        ),
        (
            "test_steps_of_the_searches.py",
            "test_normal_form_hopf_fold.py",
            "test_limit_cycles_van_der_pol.py",
            "test_settled_branch.py",
            "test_limit_cycles_stiff_contact.py",
        ),
        deselected="adapted_mesh or descent or critical_disturbance or branch_over_mu or order_of",
    ),
    "settling": Group(
        _under(
            "stability/hunting",
            "settling descent disturbance watching measured_growth settled_branch settled_orbit",
        ),
        (
            "test_what_amplitudes_and_multipliers_say.py",
            "test_normal_form_hopf_fold.py",
            "test_settled_branch.py",
            "test_descent_by_truck.py",
        ),
        deselected="supercritical_branch or order_of or every_cycle or begins_at "
        "or simulated_state",
    ),
    "nonlinear": Group(
        _under("stability/hunting", "nonlinear large_starts truck_speeds diagram"),
        ("test_normal_form_hopf_fold.py", "test_limit_cycles_endings.py"),
        deselected="disturbance_runs or convergence_at_the or speed_range or critical_disturbance "
        "or order_of",
    ),
    "linear": Group(
        _under(
            "stability/linear",
            "critical_speed crossings law_checks linearisation modes neutral simulated_growth "
            "spectra",
        ),
        (
            "test_steps_of_the_searches.py",
            "test_linearisation_gyroscope.py",
            "test_linearisation_closed_forms.py",
            "test_modes_and_windows.py",
            "test_law_checks.py",
            "test_friction_at_rest_and_roots.py",
            "test_linearisation_rolling_cone.py",
        ),
        deselected="inside_the_band",
    ),
    "gradients": Group(
        ("stability/gradients.py", "stability/design.py", "stability/numbers.py"),
        ("test_gradients_against_differences.py",),
        deselected="slow or whole_diagrams",
    ),
}
