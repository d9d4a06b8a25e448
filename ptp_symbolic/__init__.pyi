"""Types of what `__init__.py` imports on demand."""

from ptp_symbolic.api.batch import batch_function as batch_function
from ptp_symbolic.api.batch import simulate_batch as simulate_batch
from ptp_symbolic.api.batch_results import Batch as Batch
from ptp_symbolic.api.effect_laws import check_effect as check_effect
from ptp_symbolic.api.export import export as export
from ptp_symbolic.api.linearization import Linearization as Linearization
from ptp_symbolic.api.logs import Log as Log
from ptp_symbolic.api.logs import read_log as read_log
from ptp_symbolic.api.logs import sample as sample
from ptp_symbolic.api.machine import Jacobian as Jacobian
from ptp_symbolic.api.machine import Machine as Machine
from ptp_symbolic.api.machine import load as load
from ptp_symbolic.api.results import Diagnosis as Diagnosis
from ptp_symbolic.api.results import Estimate as Estimate
from ptp_symbolic.api.results import Experiment as Experiment
from ptp_symbolic.api.results import FitResult as FitResult
from ptp_symbolic.api.results import FrictionMap as FrictionMap
from ptp_symbolic.api.results import diagnose as diagnose
from ptp_symbolic.api.results import experiment as experiment
from ptp_symbolic.api.results import fit as fit
from ptp_symbolic.api.results import friction_map as friction_map
from ptp_symbolic.api.run import Run as Run
from ptp_symbolic.api.simulation import sensitivity as sensitivity
from ptp_symbolic.api.simulation import simulate as simulate
from ptp_symbolic.errors import InputError as InputError
from ptp_symbolic.formats.robots.imported import ImportedPlatform as ImportedPlatform
from ptp_symbolic.formats.robots.imported import read_robot as read_robot
from ptp_symbolic.models.inverse_dynamics import inverse_dynamics as inverse_dynamics
from ptp_symbolic.numeric.runtime.model import Model as Model
from ptp_symbolic.numeric.sensitivities import Sensitivities as Sensitivities
from ptp_symbolic.numeric.simulation.run import Event as Event
from ptp_symbolic.numeric.simulation.run import SimulationError as SimulationError
from ptp_symbolic.platform import Platform as Platform
from ptp_symbolic.platform import read_platform as read_platform
from ptp_symbolic.symbolic.effect_interface.effect import Effect as Effect

__version__: str
