// java -cp lcm.jar:hydro.jar ReadLog.java LOG decodes each message of the log with the type of its
// fingerprint, encodes it again, and prints by type how many came out unchanged, and the arm's last angle.
import java.io.ByteArrayInputStream;
import java.io.ByteArrayOutputStream;
import java.io.DataInput;
import java.io.DataInputStream;
import java.io.DataOutputStream;
import java.io.EOFException;
import java.util.Arrays;
import java.util.TreeMap;
import lcm.lcm.LCMEncodable;
import lcm.logging.Log;
import lcm.spy.LCMTypeDatabase;

public class ReadLog {
  public static void main(String[] arguments) throws Exception {
    LCMTypeDatabase types = new LCMTypeDatabase();
    TreeMap<String, Integer> same = new TreeMap<>();
    double angle = Double.NaN;
    Log log = new Log(arguments[0], "r");
    try {
      while (true) {
        Log.Event event = log.readNext();
        if (!event.channel.startsWith("HYDRO_")) continue;
        long fingerprint = new DataInputStream(new ByteArrayInputStream(event.data)).readLong();
        Class<?> type = types.getClassByFingerprint(fingerprint);
        if (type == null) continue;
        Object message = type.getConstructor(DataInput.class).newInstance(new DataInputStream(new ByteArrayInputStream(event.data)));
        ByteArrayOutputStream bytes = new ByteArrayOutputStream();
        ((LCMEncodable) message).encode(new DataOutputStream(bytes));
        if (Arrays.equals(bytes.toByteArray(), event.data)) same.merge(event.channel, 1, Integer::sum);
        if (message instanceof hydro.state_t) angle = ((hydro.state_t) message).arm_angle;
      }
    } catch (EOFException end) {
      System.out.println(same + " " + angle);
    }
  }
}
