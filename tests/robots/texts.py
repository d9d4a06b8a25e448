"""Robots written by hand, as others would write them: a turret in URDF and a head in MJCF."""

TURRET = """<?xml version="1.0"?>
<robot name="turret">
  <link name="base_link"><inertial><mass value="12"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="mount" type="fixed">
    <parent link="base_link"/><child link="pedestal"/>
    <origin xyz="0.1 -0.2 0.5" rpy="0 0 0.7"/>
  </joint>
  <link name="pedestal"/>
  <joint name="yaw" type="continuous">
    <parent link="pedestal"/><child link="yoke"/><origin xyz="0 0 0.1"/>
    <axis xyz="0 0 2"/><dynamics damping="0.4" friction="0"/>
  </joint>
  <link name="yoke">
    <inertial><origin xyz="0.02 -0.03 0.08" rpy="0.3 -0.2 0.9"/><mass value="3.2"/>
      <inertia ixx="0.021" ixy="0.001" ixz="-0.002" iyy="0.030" iyz="0.0015" izz="0.025"/>
    </inertial>
  </link>
  <joint name="box_mount" type="fixed">
    <parent link="yoke"/><child link="electronics"/>
    <origin xyz="-0.15 0.05 0.02" rpy="0.1 0.4 -0.3"/>
  </joint>
  <link name="electronics">
    <inertial><origin xyz="0.01 0.02 -0.01" rpy="0.5 0.6 0.7"/><mass value="0.8"/>
      <inertia ixx="0.002" ixy="0.0002" ixz="0" iyy="0.0015" iyz="-0.0001" izz="0.0018"/>
    </inertial>
  </link>
  <joint name="pitch" type="revolute">
    <parent link="yoke"/><child link="cradle"/>
    <origin xyz="0.06 0.11 0.25" rpy="0 0 -0.35"/>
    <axis xyz="0 -1 0"/><dynamics damping="0.25"/>
    <limit lower="-7" upper="6" effort="20" velocity="3"/>
  </joint>
  <link name="cradle">
    <inertial><origin xyz="0.01 0.04 0.03" rpy="-0.4 0.2 0.1"/><mass value="1.1"/>
      <inertia ixx="0.004" ixy="-0.0003" ixz="0.0002" iyy="0.005" iyz="0.0004" izz="0.0045"/>
    </inertial>
  </link>
  <joint name="camera_mount" type="fixed">
    <parent link="cradle"/><child link="camera"/>
    <origin xyz="0.12 -0.01 0.05" rpy="1.1 0.2 -0.7"/>
  </joint>
  <link name="camera">
    <inertial><origin xyz="0.03 0 0.01" rpy="0.2 0.9 0.4"/><mass value="2.4"/>
      <inertia ixx="0.006" ixy="0.0005" ixz="0.0004" iyy="0.008" iyz="-0.0006" izz="0.007"/>
    </inertial>
  </link>
</robot>
"""

# A leaning mast, masses from shapes, classes, a rotor larger than the head that it turns.
HEAD = """<mujoco model="head">
  <compiler angle="degree" eulerseq="ZYX"/>
  <option gravity="0.4 -0.3 -9.7"><flag contact="disable"/></option>
  <default>
    <geom density="700"/>
    <joint damping="0.2"/>
    <default class="servo">
      <joint damping="0.3" armature="0.05" stiffness="1.5" springref="10"/>
      <default class="stiff_servo"><joint stiffness="2.5"/></default>
    </default>
  </default>
  <worldbody>
    <geom type="plane" size="1 1 0.1"/>
    <body name="mast" pos="0.3 0 1" euler="20 0 0">
      <geom type="box" size="0.1 0.1 0.5"/>
      <body name="turntable" pos="0 0 0.5">
        <joint name="pan" class="servo" ref="5" pos="0.02 0.01 0"/>
        <inertial pos="0.01 0.02 0.03" mass="2.5"
          fullinertia="0.02 0.03 0.025 0.001 -0.002 0.0015"/>
        <geom type="sphere" size="0.3"/>
        <body name="arm" pos="0 0 0.1" quat="0.9 0.1 -0.2 0.3">
          <geom type="capsule" fromto="0 0 0 0.1 0.2 0.1" size="0.03"/>
          <geom type="cylinder" size="0.05 0.04" pos="0.1 0 0" zaxis="1 1 0" mass="0.4"/>
          <geom type="ellipsoid" size="0.05 0.04 0.06" pos="0 0.1 0" axisangle="1 2 3 40"/>
          <geom type="sphere" size="0.04" pos="-0.1 0 0.05"/>
          <geom type="box" size="0.05 0.02 0.03" pos="0 -0.1 0.05" xyaxes="1 1 0 0 1 1"/>
          <geom type="capsule" size="0.02 0.03" density="0"/>
        </body>
        <body name="head" pos="0.05 0.03 0.2" euler="-30 0 0" childclass="stiff_servo">
          <joint name="tilt" axis="0 1 0"/>
          <inertial pos="0.08 0.01 -0.02" mass="1.7" diaginertia="0.01 0.012 0.009"
            quat="0.8 0.3 -0.4 0.2"/>
          <body name="lens" pos="0.1 0 0.03" euler="10 20 30">
            <geom type="cylinder" fromto="0 0 0 0.2 0 0.05" size="0.03" density="1500"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="turn" joint="pan" gear="20"/>
    <general name="nod" joint="tilt"/>
  </actuator>
</mujoco>
"""

# Both joints in one body, the pan axis down, a wheel that carries nothing, a joint in the chain.
UPSIDE_DOWN = """<mujoco>
  <compiler angle="radian" inertiafromgeom="false"/>
  <worldbody>
    <body name="wheel"><joint name="roll" axis="0 1 0"/>
      <inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body>
    <body name="lift" pos="0 0 1"><joint name="up" type="slide" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="3" diaginertia="0.1 0.1 0.1"/>
      <body name="ball" pos="0.1 0.2 0.3">
        <joint name="pan" axis="0 0 -1" springref="0.3" stiffness="0.7" range="-20 30"/>
        <joint name="tilt" axis="1 0 0" pos="0.03 0.02 0.05" armature="0.001"/>
        <inertial pos="0.05 0.1 0.06" mass="2" fullinertia="0.01 0.02 0.015 0.001 0.002 -0.001"/>
        <body name="flap" pos="0.1 0 0"><joint name="swing" axis="0 0 1"/>
          <inertial pos="0 0.1 0" mass="0.3" diaginertia="0.001 0.001 0.002"/></body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
