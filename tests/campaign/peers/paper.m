% The experiment of Sourav & Cheng (RTSS 2024) as a script: three cars in one lane, radar and LiDAR
% in fog, an extended Kalman filter, MPC cruise control in host and follower, a human driver (IDM),
% and an arbitrator that trades control by the Degree of Conflict.
%
% The script checks Fogline's results and shares no code with Fogline. It has the same equations and
% parameters in another language, with another QP solver. It draws its own random numbers, so its
% tables agree with Fogline's only without sensor noise.
%
%   octave-cli tests/campaign/peers/paper.m SCENARIO.json            the table, as JSON
%   octave-cli tests/campaign/peers/paper.m SCENARIO.json RUNS       seconds for RUNS runs, as JSON
%
% SCENARIO.json is an effective scenario: the output of `fogline check --print`.
1;

% ---- vehicles -----------------------------------------------------------------------------------

% A point mass with a constant acceleration. After it has braked to a stop, it does not move.
function car = drive(car, command, h)
  v = car.speed;
  if command < 0 && v / -command <= h
    car.position += v^2 / (2 * -command);
    car.speed = 0;
    car.acceleration = -v / h;
  else
    car.position += v * h + command * h^2 / 2;
    car.speed = v + command * h;
    car.acceleration = command;
  end
end

function d = gap(behind, ahead, world)
  d = ahead.position - world.vehicle_length_m - behind.position;
  assert(d > 0, 'the cars collide, which this script knows nothing of');
end

% ---- fog and sensors ----------------------------------------------------------------------------

function [present, level] = fog_at(fog, t)
  since = round((t - fog.start_s) * 1e6);    % in whole microseconds, so rounding loses no step
  duration = round(fog.duration_s * 1e6);
  present = since >= 0 && since < duration && !strcmp(fog.model, 'none');
  level = 0;
  if present
    x = since / duration;
    switch fog.profile
      case 'box',           level = 1;
      case 'half_sine',     level = sin(pi * x);
      case 'raised_cosine', level = (1 - cos(2 * pi * x)) / 2;
      case 'triangle',      level = 1 - abs(2 * x - 1);
    end
  end
end

% ---- extended Kalman filter ---------------------------------------------------------------------

% State [distance; relative speed; acceleration of the preceding car], with white-noise jerk. The
% host's own acceleration is known, so it is an input.
function kf = make_filter(fusion, h)
  kf.F = [1 h h^2/2; 0 1 h; 0 0 1];
  kf.B = [-h^2/2; -h; 0];
  kf.Q = fusion.jerk_density_m2ps5 * ...
         [h^5/20 h^4/8 h^3/6; h^4/8 h^3/3 h^2/2; h^3/6 h^2/2 h];
  kf.H = [1 0 0; 0 1 0; 1 0 0];              % radar range, radar range rate, LiDAR range
  kf.R = diag([fusion.radar_range_std_m, fusion.radar_range_rate_std_mps, ...
               fusion.lidar_range_std_m].^2);
  kf.P0_acceleration = fusion.initial_acceleration_std_mps2^2;
  kf.x = [];
  kf.P = [];
end

function kf = filter_step(kf, y, host_acceleration)
  if isempty(kf.x)                           % starts from the radar; the LiDAR corrects this state
    kf.x = [y(1); y(2); 0];
    kf.P = diag([kf.R(1,1), kf.R(2,2), kf.P0_acceleration]);
    H = kf.H(3,:);
    R = kf.R(3,3);
    y = y(3);
  else
    kf.x = kf.F * kf.x + kf.B * host_acceleration;
    kf.P = kf.F * kf.P * kf.F' + kf.Q;
    H = kf.H;
    R = kf.R;
  end
  K = kf.P * H' / (H * kf.P * H' + R);
  kf.x = kf.x + K * (y - H * kf.x);
  kf.P = (eye(3) - K * H) * kf.P;
end

% ---- adaptive cruise control --------------------------------------------------------------------

% The constant parts of the model predictive controller: the prediction x_1..x_N = F x + G u, the
% cost, and the rows of the limits on z = [u_0; ...; u_{N-1}; s].
function mpc = make_mpc(acc, h)
  N = acc.horizon_steps;
  A = [0 1 -acc.headway_s; 0 0 -1; 0 0 -1/acc.engine_time_constant_s];
  B = [0; 0; -acc.engine_gain/acc.engine_time_constant_s];
  M = expm([A B; zeros(1, 4)] * h);
  mpc.Ad = M(1:3, 1:3);
  mpc.Bd = M(1:3, 4);

  F = zeros(3 * N, 3);
  G = zeros(3 * N, N);
  for j = 1:N
    F(3*j-2:3*j, :) = mpc.Ad^j;
    for i = 1:j
      G(3*j-2:3*j, i) = mpc.Ad^(j-i) * mpc.Bd;
    end
  end

  % sum of w_d delta_d^2 + w_v delta_v^2 + w_a a^2 + w_u u^2 + w_du (u_j - u_{j-1})^2, and w_s s^2
  Q = kron(eye(N), diag([acc.weight_distance, acc.weight_speed, acc.weight_acceleration]));
  D = eye(N) - diag(ones(N - 1, 1), -1);
  Hu = 2 * (G' * Q * G + acc.weight_control * eye(N) + acc.weight_control_change * (D' * D));
  mpc.H = blkdiag((Hu + Hu') / 2, 2 * acc.min_gap_weight);
  mpc.q_x = [2 * G' * Q * F; zeros(1, 3)];
  mpc.q_u = [-2 * acc.weight_control_change * D(1, :)'; 0];

  pick_gap = kron(eye(N), [1, -acc.headway_s, 0]);     % d_j = pick_gap x_j + T v_preceding + d_0
  mpc.gap_x = pick_gap * F;
  speed_u = -acc.engine_gain * h * tril(ones(N));      % w_j = w + speed_u u, w = v + T_e a
  mpc.rows = [D, zeros(N, 1);                          % change of u
              speed_u, zeros(N, 1);                    % speed limit
              speed_u, ones(N, 1);                     % no reversing, except by s
              pick_gap * G, (N:-1:1)' / N];            % smallest gap, except by s

  mpc.acc = acc;
  mpc.N = N;
  mpc.u_min = -acc.max_acceleration_mps2 / acc.engine_gain;
  mpc.u_max = -acc.min_acceleration_mps2 / acc.engine_gain;
  mpc.du_max = acc.max_jerk_mps3 * h / acc.engine_gain;
  mpc.h = h;
  mpc.z = zeros(N + 1, 1);
  mpc.command = 0;
  mpc.u = 0;
end

% The next u of the fall-back plan. In this plan u approaches the fall-back deceleration as fast as
% the limits of u and of its change allow. These limits always allow this plan.
function u = fallback(mpc, u_before)
  target = min(mpc.acc.fallback_deceleration_mps2 / mpc.acc.engine_gain, mpc.u_max);
  u = min(max(target, u_before - mpc.du_max), u_before + mpc.du_max);
end

function [mpc, command] = acc_step(mpc, distance, relative_speed, speed, acceleration)
  acc = mpc.acc;
  N = mpc.N;
  % The limit on the change of u applies from the car's real acceleration, because the human may
  % have driven before.
  if abs(acceleration - mpc.command) <= 1e-6
    u_before = mpc.u;
  else
    u_before = -acceleration / acc.engine_gain;
  end
  u_before = min(max(u_before, mpc.u_min), mpc.u_max);

  x = [distance - (acc.headway_s * speed + acc.standstill_m); relative_speed; acceleration];
  w = speed + acc.engine_time_constant_s * acceleration;
  w_limit = zeros(N, 1);                     % the speed limit, or the fall-back plan's higher speed
  w_fallback = w;
  u_fallback = u_before;
  for j = 1:N
    u_fallback = fallback(mpc, u_fallback);
    w_fallback -= acc.engine_gain * mpc.h * u_fallback;
    w_limit(j) = max(acc.max_speed_mps, w_fallback);
  end
  gap_free = mpc.gap_x * x + acc.headway_s * (speed + relative_speed) + acc.standstill_m;

  from = [u_before; zeros(N - 1, 1)];
  unlimited = inf(N, 1);
  lower = [from - mpc.du_max; -unlimited; -w * ones(N, 1); acc.min_gap_m - gap_free];
  upper = [from + mpc.du_max; w_limit - w; unlimited; unlimited];
  z_min = [mpc.u_min * ones(N, 1); -inf];
  z_max = [mpc.u_max * ones(N, 1); inf];
  q = mpc.q_x * x + mpc.q_u * u_before;
  [z, ~, info] = qp(mpc.z, mpc.H, q, [], [], z_min, z_max, lower, mpc.rows, upper);
  if info.info == 0
    mpc.z = z;
    mpc.u = z(1);
  else
    mpc.u = fallback(mpc, u_before);
  end
  command = mpc.Ad(3, 3) * acceleration + mpc.Bd(3) * mpc.u;
  mpc.command = command;
end

% ---- human driver -------------------------------------------------------------------------------

% Intelligent Driver Model (Treiber, Hennecke & Helbing 2000).
function a = idm(driver, speed, preceding_speed, distance)
  a_max = driver.max_acceleration_mps2;
  b = driver.comfortable_deceleration_mps2;
  closing = speed - preceding_speed;
  desired = driver.standstill_m + ...
            max(0, speed * driver.headway_s + speed * closing / (2 * sqrt(a_max * b)));
  a = a_max * (1 - (speed / driver.desired_speed_mps)^driver.exponent - (desired / distance)^2);
  a = max(a, -driver.max_deceleration_mps2);
end

% ---- one run ------------------------------------------------------------------------------------

% The fields of the result have one row for each step: compromised safety (m), fog, human in
% control.
function run = experiment(s, threshold, traded)
  h = s.step_s;
  preceding = struct('position', s.world.host_gap_m + s.world.vehicle_length_m, ...
                     'speed', s.lead.speed_mps, 'acceleration', 0);
  host = struct('position', 0, 'speed', s.world.host_speed_mps, 'acceleration', 0);
  follower = struct('position', -s.world.follower_gap_m - s.world.vehicle_length_m, ...
                    'speed', s.world.follower_speed_mps, 'acceleration', 0);
  kf = make_filter(s.fusion, h);
  host_mpc = make_mpc(s.acc, h);
  follower_mpc = make_mpc(s.follower, h);
  differences = [];
  run.compromised = zeros(s.steps, 1);
  run.fog = false(s.steps, 1);
  run.human = false(s.steps, 1);

  for k = 1:s.steps
    host_gap = gap(host, preceding, s.world);
    follower_gap = gap(follower, host, s.world);
    [run.fog(k), level] = fog_at(s.fog, (k - 1) * h);

    % The measurements: fog makes the LiDAR's range too short.
    radar = max(0, host_gap + s.radar.bias_m + s.radar.range_std_m * randn());
    rate = preceding.speed - host.speed + s.radar.range_rate_std_mps * randn();
    lidar = max(0, host_gap - s.fog.bias_m * level + s.lidar.bias_m + s.lidar.range_std_m * randn());
    kf = filter_step(kf, [radar; rate; lidar], host.acceleration);

    % The accelerations that the automation and the driver propose.
    [host_mpc, a_automation] = acc_step(host_mpc, kf.x(1), kf.x(2), host.speed, host.acceleration);
    a_human = idm(s.driver, host.speed, preceding.speed, host_gap);

    % The Degree of Conflict over the last differences decides who drives.
    differences(end + 1) = radar - lidar;
    window = differences(max(1, end - s.arbitrator.window_steps + 1):end);
    if strcmp(s.arbitrator.conflict, 'mean_of_absolute')
      z = mean(abs(window));
    else
      z = abs(mean(window));
    end
    doc = 1 / (1 + exp(-s.arbitrator.doc_slope_per_m * (z - s.arbitrator.doc_centre_m)));
    lambda_a = !traded || doc < threshold;
    lambda_h = 1 - lambda_a;
    a_host = lambda_h * a_human + lambda_a * a_automation;
    run.human(k) = lambda_h > 0;

    [follower_mpc, a_follower] = acc_step(follower_mpc, follower_gap, host.speed - follower.speed, ...
                                          follower.speed, follower.acceleration);
    safe = s.follower.headway_s * follower.speed + s.follower.standstill_m;
    run.compromised(k) = max(0, safe - follower_gap);

    preceding = drive(preceding, 0, h);
    host = drive(host, a_host, h);
    follower = drive(follower, a_follower, h);
  end
end

% ---- the table ----------------------------------------------------------------------------------

function rows = make_table(s)
  without = experiment(s, 0, false);
  relevant = without.fog & without.compromised > s.measures.safety_floor_m;
  rows = {};
  for threshold = [s.published.threshold]
    with = experiment(s, threshold, true);
    improvement = (without.compromised - with.compromised)(relevant) ./ without.compromised(relevant);
    rows{end + 1} = struct('threshold', threshold, 'si_pct', 100 * mean(improvement), ...
                           'rhe_pct', 100 * mean(with.human(!with.fog)));
  end
end

% Stops with an error if the scenario has a feature that this script does not have.
function refuse_what_is_missing(s)
  assert(strcmp(s.lead.profile, 'constant'), 'only a preceding car at constant speed');
  assert(any(strcmp(s.fog.model, {'none', 'bias'})), 'only fog models none and bias');
  assert(s.fog.rain_mmph == 0, 'no rain');
  assert(s.radar.lateral_offset_m == 0 && s.lidar.lateral_offset_m == 0, 'no lateral offsets');
  assert(s.radar.dropout_probability == 0 && s.lidar.dropout_probability == 0, 'no dropouts');
  assert(!s.fusion.gating, 'no gating');
end

arguments = argv();
scenario = jsondecode(fileread(arguments{1}));
refuse_what_is_missing(scenario);
randn('state', scenario.seed);
if numel(arguments) == 1
  result.rows = make_table(scenario);
else
  result.runs = str2double(arguments{2});
  began = tic();
  for n = 1:result.runs
    experiment(scenario, scenario.arbitrator.threshold, true);
  end
  result.wall_s = toc(began);
end
disp(jsonencode(result));
